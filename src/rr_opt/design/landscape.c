/* Steady cycles of sine gaits on robots with viscous friction, as design/landscape.py has them.

   vdot = a v + b is given at n phases and halfway between them; Hermite-Simpson steps make of it a
   line from each phase to the next, and the cycle closes at the fixed point of them all. */

/* What comes out: a number for each of `count` gaits, or n rows of them. */
typedef struct {
  double *speed, *turn, *mean, *v, *chi, *torque;
} Cycles;

/* phi and its first two derivatives in time. */
static void posture(const Points* points, V omega, double sine, double cosine, V* x) {
  V swing = points->amplitude * sine;
  x[0] = swing + points->offset;
  x[1] = points->amplitude * omega * cosine;
  x[2] = -(omega * omega * swing);
}

/* work: 10 n V */
static void block(const Points* points, long long n, const double* sine, const double* cosine,
                  V* work, long long from, long long count, const Cycles* out) {
  V *a = work, *b = a + 2 * n, *gain = b + 2 * n, *shift = gain + n, *w = shift + n;
  V *side = w + n, *v = side + n, *rate = v + n;
  V omega = 2.0 * PI / points->period, h = points->period / (double)n, x[4], c[6];
  V kept[NK_AFFINE + 1], kept_torque[NK_TORQUE + 1];
  V product = all(1.0), total = all(0.0), turn = all(0.0), chi = all(0.0);
  V vx = all(0.0), vy = vx, ex = vx, ey = vx;
  double each = 1.0 / (double)n;
  long long i, k;
  affine_0(points->p, kept);
  torque_0(points->p, kept_torque);
  for (i = 0; i < 2 * n; ++i) {
    posture(points, omega, sine[i], cosine[i], x);
    affine_1(x, kept, c);
    a[i] = c[0], b[i] = c[1];
    if (i % 2 == 0) {
      /* For now what v is multiplied by. */
      w[i / 2] = c[2], rate[i / 2] = c[3], side[i / 2] = c[4], v[i / 2] = c[5];
    }
  }
  for (k = 0; k < n; ++k) {
    long long next = k + 1 < n ? 2 * k + 2 : 0;
    V a0 = a[2 * k], am = a[2 * k + 1], a1 = a[next], b0 = b[2 * k], b1 = b[next];
    V divisor = 1.0 - h / 6.0 * (a1 + am * (2.0 - h / 2.0 * a1));
    gain[k] = (1.0 + h / 6.0 * (a0 + am * (2.0 + h / 2.0 * a0))) / divisor;
    shift[k] = h / 6.0 * (b0 + 4.0 * b[2 * k + 1] + b1 + h / 2.0 * am * (b0 - b1)) / divisor;
    product = gain[k] * product;
    total = gain[k] * total + shift[k];
  }
  total = total / (1.0 - product);
  for (k = 0; k < n; ++k) {
    V here = total, torque;
    w[k] = w[k] * here + rate[k];
    side[k] = side[k] * here + v[k];
    v[k] = here;
    total = gain[k] * here + shift[k];
    turn += w[k];
    x[0] = here;
    posture(points, omega, sine[2 * k], cosine[2 * k], x + 1);
    torque_1(x, kept_torque, &torque);
    scatter(from, count, here, out->v + k * count);
    scatter(from, count, torque, out->torque + k * count);
  }
  turn = turn * points->period * each;
  for (k = 0; k < n; ++k) rate[k] = points->period * w[k] - turn;
  for (k = 0; k < n; ++k) {
    V cosine_chi = v_cos(chi), sine_chi = v_sin(chi);
    vx += cosine_chi * v[k] - sine_chi * side[k];
    vy += sine_chi * v[k] + cosine_chi * side[k];
    ex += cosine_chi;
    ey += sine_chi;
    scatter(from, count, chi, out->chi + k * count);
    /* Integral over an interval of what is periodic from four nodes, order 4. */
    chi += (13.0 * (rate[k] + rate[(k + 1) % n]) - rate[(k + n - 1) % n] - rate[(k + 2) % n]) *
           (each / 24.0);
  }
  vx *= each, vy *= each, ex *= each, ey *= each;
  scatter(from, count, signed_speed(vx, vy, ex, ey), out->speed);
  scatter(from, count, turn, out->turn);
  scatter(from, count, vx, out->mean);
  scatter(from, count, vy, out->mean + count);
  scatter(from, count, ex, out->mean + 2 * count);
  scatter(from, count, ey, out->mean + 3 * count);
}

/* sine, cosine: at 2 n phases; p: NP numbers a gait. Returns whether there was memory. */
int rr_landscape(long long count, long long n, const double* amplitude, const double* offset,
                 const double* period, const long long* which, const double* p,
                 const double* sine, const double* cosine, double* speed, double* turn,
                 double* mean, double* v, double* chi, double* torque) {
  Points points;
  Cycles out = {speed, turn, mean, v, chi, torque};
  V* work = aligned_alloc(sizeof(V), sizeof(V) * 10 * n);
  long long from;
  if (!work) return 0;
  for (from = 0; from < count; from += L) {
    gather(&points, from, count, amplitude, offset, period, which, p);
    block(&points, n, sine, cosine, work, from, count, &out);
  }
  free(work);
  return 1;
}
