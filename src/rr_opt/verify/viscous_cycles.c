/* Steady cycles of robots with viscous friction by Fourier series, as verify/steady_fourier.py.

   n samples of a span: half a period of a straight gait, else a whole one. The matrices of
   verify/spectral.py for this number of samples stand in one table, one after the other. */

typedef struct {
  const double *sine, *cosine;       /* of the phase, n each */
  const double *integral, *turning;  /* of what repeats after a span, and of what w is: n n */
  const double *forward, *back;      /* to cosines 0 .. n/2 and sines 1 .. n/2 - 1, and back: n n */
  const double *tail, *side_tail;    /* t n */
  const double *dense;               /* r n */
} Table;

/* What exp(A) magnifies by more than exp(STIFF) is not trusted to it where the other way gains a
   digit every ten times or faster. */
#define STIFF 15.0
#define SHARE 0.8
#define REPLACED 120
#define EPSILON 2.2e-16

/* y (rows) = m (rows, n) x (n) */
static void apply(const double* restrict m, long long rows, long long n, const V* restrict x,
                  V* restrict y) {
  long long r = 0, j;
  for (; r + 8 <= rows; r += 8, m += 8 * n) {
    V s0 = all(0.0), s1 = s0, s2 = s0, s3 = s0, s4 = s0, s5 = s0, s6 = s0, s7 = s0;
    for (j = 0; j < n; ++j) {
      V here = x[j];
      s0 += m[j] * here;
      s1 += m[j + n] * here;
      s2 += m[j + 2 * n] * here;
      s3 += m[j + 3 * n] * here;
      s4 += m[j + 4 * n] * here;
      s5 += m[j + 5 * n] * here;
      s6 += m[j + 6 * n] * here;
      s7 += m[j + 7 * n] * here;
    }
    y[r] = s0, y[r + 1] = s1, y[r + 2] = s2, y[r + 3] = s3;
    y[r + 4] = s4, y[r + 5] = s5, y[r + 6] = s6, y[r + 7] = s7;
  }
  for (; r < rows; ++r, m += n) {
    V sum = all(0.0);
    for (j = 0; j < n; ++j) sum += m[j] * x[j];
    y[r] = sum;
  }
}

static V largest(const V* x, long long n) {
  V top = all(0.0);
  long long i;
  for (i = 0; i < n; ++i) top = v_max(v_abs(x[i]), top);
  return top;
}

/* y of dy/dt = mean y + x, harmonic by harmonic. */
static void lagging(const Table* t, long long n, V span, V mean, const V* x, V* harmonics, V* y) {
  long long k, half = n / 2;
  V base = 2.0 * PI / span, square = mean * mean;
  apply(t->forward, n, n, x, harmonics);
  for (k = 0; k <= half; ++k) {
    V omega = base * (double)k, size = 1.0 / (square + omega * omega), c = harmonics[k];
    if (k == 0 || k == half) {
      harmonics[k] = -mean * c * size;
    } else {
      V s = harmonics[half + k];
      harmonics[k] = (omega * s - mean * c) * size;
      harmonics[half + k] = -(mean * s + omega * c) * size;
    }
  }
  apply(t->back, n, n, harmonics, y);
}

/* v of dv/dt = a v + b where `stiff`, again and again with the constant `middle` for a and what is
   left of a v added to b: the error falls to SHARE or less each time. x, next, harmonics: room. */
static void replacing(const Table* t, long long n, V span, Bits stiff, V middle, const V* a,
                      const V* b, V* x, V* next, V* harmonics, V* v) {
  long long i;
  int steps = REPLACED;
  Bits going = stiff;
  for (i = 0; i < n; ++i) v[i] = pick(stiff, all(0.0), v[i]);
  while (steps-- && any(going)) {
    V change = all(0.0), top = all(0.0);
    for (i = 0; i < n; ++i) x[i] = b[i] + (a[i] - middle) * v[i];
    lagging(t, n, span, middle, x, harmonics, next);
    for (i = 0; i < n; ++i) {
      change = v_max(v_abs(next[i] - v[i]), change);
      top = v_max(v_abs(next[i]), top);
      v[i] = pick(stiff, next[i], v[i]);
    }
    going = stiff & (change > 1e-13 * top);
  }
}

/* work: 16 n + r + NK1 n or more V. results: speed, turn, peak torque, error. */
static void viscous_block(const Points* points, const Table* t, int straight, long long n,
                          long long tails, long long side_tails, long long r, V* work, V* results) {
  V *a = work, *b = a + n, *A = b + n, *x = A + n, *v = x + n, *w = v + n, *side = w + n;
  V *torque = side + n, *chi = torque + n, *powers = chi + n, *dense = powers + 15 * n;
  V kept[NK0 + 1], omega = 2.0 * PI / points->period, mean = all(0.0), turn = all(0.0);
  V span = straight ? points->period / 2.0 : points->period;
  V vx = all(0.0), vy = vx, ex = vx, ey = vx, top = vx, speed, scale;
  V least = all(INFINITY), most = -least, low = least, high = most, rounding;
  double each = 1.0 / (double)n;
  Bits stiff;
  long long i;
  rr_0(points->p, kept);
  for (i = 0; i < n; ++i) {
    V swing = points->amplitude * t->sine[i], phi = swing + points->offset, *c = powers + 15 * i;
    V q = points->amplitude * t->cosine[i] * omega, bend = -swing * omega * omega;
    rr_1(&phi, kept, c);
    /* vdot = a v + b */
    a[i] = c[0] * q + c[1];
    b[i] = (c[2] * q + c[3]) * q + c[4] * bend;
    mean += a[i];
    least = v_min(a[i], least);
    most = v_max(a[i], most);
  }
  mean *= each;
  apply(t->integral, n, n, a, A);
  for (i = 0; i < n; ++i) {
    V exponent = A[i] * span;
    low = v_min(exponent, low);
    high = v_max(exponent, high);
    A[i] = v_exp(exponent);
    x[i] = b[i] / A[i];
  }
  lagging(t, n, span, mean, x, w, v);
  for (i = 0; i < n; ++i) v[i] *= A[i];
  rounding = EPSILON * v_exp(high - low);
  stiff = (high - low > all(STIFF)) & (most - least < -SHARE * (most + least));
  if (any(stiff)) {
    replacing(t, n, span, stiff, (most + least) / 2.0, a, b, side, torque, w, v);
    rounding = pick(stiff, all(0.0), rounding);
  }
  for (i = 0; i < n; ++i) {
    V u = v[i], *c = powers + 15 * i;
    V q = points->amplitude * t->cosine[i] * omega;
    V bend = -points->amplitude * t->sine[i] * omega * omega;
    w[i] = c[5] * u + c[6] * q;
    side[i] = c[7] * u + c[8] * q;
    torque[i] = (c[9] * u + c[10] * q + c[11]) * u + (c[12] * q + c[13]) * q + c[14] * bend;
    top = v_max(v_abs(u), top);
    turn += w[i];
  }
  apply(t->turning, n, n, w, chi);
  for (i = 0; i < n; ++i) {
    V angle = chi[i] * span, cosine = v_cos(angle), sine = v_sin(angle);
    vx += cosine * v[i] - sine * side[i];
    vy += sine * v[i] + cosine * side[i];
    ex += cosine;
    ey += sine;
  }
  /* In the mirror image sideways is the other way: over the whole period nothing is left. */
  if (straight) vy = ey = turn = all(0.0);
  speed = signed_speed(vx, vy, ex, ey) * each;
  scale = v_max(v_abs(speed), 1e-3 * top) + 1e-12;
  apply(t->tail, tails, n, v, x);
  apply(t->side_tail, side_tails, n, side, a);
  results[0] = speed;
  results[1] = turn * span * each;
  results[3] = (largest(x, tails) + largest(a, side_tails) + rounding * top) / scale;
  /* A disturbance that does not die out leaves no steady cycle. */
  results[3] = pick(mean * span < all(-1e-9), results[3], all(INFINITY));
  apply(t->dense, r, n, torque, dense);
  results[2] = peak(dense, r);
}

/* out (4, count): speed, turn, peak torque, error. Returns whether there was memory. */
int rr_viscous(long long count, const double* amplitude, const double* offset,
               const double* period, const long long* which, const double* p, int straight,
               long long n, long long tails, long long side_tails, long long r,
               const double* table, double* out) {
  Table t;
  Points points;
  V results[4], *work = aligned_alloc(sizeof(V), sizeof(V) * (24 * n + r));
  long long from;
  int k;
  if (!work) return 0;
  t.sine = table, t.cosine = t.sine + n, t.integral = t.cosine + n;
  t.turning = t.integral + n * n, t.forward = t.turning + n * n, t.back = t.forward + n * n;
  t.tail = t.back + n * n, t.side_tail = t.tail + tails * n, t.dense = t.side_tail + side_tails * n;
  for (from = 0; from < count; from += L) {
    gather(&points, from, count, amplitude, offset, period, which, p);
    viscous_block(&points, &t, straight, n, tails, side_tails, r, work, results);
    for (k = 0; k < 4; ++k) scatter(from, count, results[k], out + k * count);
  }
  free(work);
  return 1;
}
