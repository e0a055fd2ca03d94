/* Steady cycles of robots whose friction is not viscous, L points at a time.

   vdot(v) is linearised about the current v along the gait, the linear equation solved for the
   cycle that repeats, and the step repeated (Newton-Kantorovich). Over one step from sample to
   sample the linear equation is a map v -> gain v + shift, with the integrals in it of order six,
   as `solve_stiff` in verify/periodic_linear.py. The samples are doubled until that changes the
   results no more. */

#define NEAR 3
#define NX (NK1 + 12)

/* The integral over a step from the six samples around it, exact for polynomials. */
#define W0 (11.0 / 1440.0)
#define W1 (-93.0 / 1440.0)
#define W2 (802.0 / 1440.0)

typedef struct {
  V *kept; /* n NK1: what depends on the posture alone */
  V *v, *a, *b, *gain, *inverse, *shift, *side, *w, *torque, *fine;
} Work;

/* x (n) with NEAR samples before and after; over a span it repeats, or changes sign. */
static void wrap(V* x, long long n, double sign) {
  int k;
  for (k = 1; k <= NEAR; ++k) x[-k] = sign * x[n - k];
  for (k = 0; k < NEAR; ++k) x[n + k] = sign * x[k];
}

INLINE V over_step(const V* x) {
  return W0 * (x[-2] + x[3]) + W1 * (x[-1] + x[2]) + W2 * (x[0] + x[1]);
}

/* The v (n) of dv/dt = a v + b that repeats, into next; returns the integral of a over the span. */
static V march(Work* k, long long n, V h, V* next) {
  V sum = all(0.0), gain = all(1.0), shift = all(0.0), v;
  V *g = k->gain, *inverse = k->inverse;
  const V *b = k->b;
  long long i;
  wrap(k->a, n, 1.0);
  wrap(k->b, n, 1.0);
  for (i = 0; i < n; ++i) {
    V x = h * over_step(k->a + i);
    sum += x;
    /* Where a step is stiffer, v is only as good as the samples are dense. */
    x = v_min(v_max(x, all(-10.0)), all(1.0));
    g[i] = v_exp(x);
    inverse[i] = 1.0 / g[i];
  }
  wrap(g, n, 1.0);
  wrap(inverse, n, 1.0);
  for (i = 0; i < n; ++i) {
    V near = g[i - 1] * (W1 * b[i - 1] + W0 * g[i - 2] * b[i - 2]) + W2 * b[i];
    V far = inverse[i + 1] * (W1 * b[i + 2] + W0 * inverse[i + 2] * b[i + 3]) + W2 * b[i + 1];
    k->shift[i] = h * (g[i] * near + far);
    shift = g[i] * shift + k->shift[i];
    gain *= g[i];
  }
  v = shift / (1.0 - gain);
  for (i = 0; i < n; ++i) {
    next[i] = v;
    v = g[i] * v + k->shift[i];
  }
  return sum;
}

/* vdot, its slope, w, side and torque of one sample. */
INLINE void motion(V v, const V* robot, const Work* k, long long i, V* out) {
  rr_2(&v, robot, k->kept + NK1 * i, out);
}

/* Where to begin: the chord of vdot from v = -1 to 1 m/s, to which dry friction is small. */
static void begin(Work* k, const V* robot, long long n, V h) {
  V low[5], high[5];
  long long i;
  for (i = 0; i < n; ++i) {
    motion(all(-1.0), robot, k, i, low);
    motion(all(1.0), robot, k, i, high);
    k->a[i] = (high[0] - low[0]) * 0.5;
    k->b[i] = (high[0] + low[0]) * 0.5;
  }
  march(k, n, h, k->v);
}

/* v at twice as many samples, n of them; 0 where it is no number. */
static void refine(Work* k, long long n) {
  long long i;
  wrap(k->v, n / 2, 1.0);
  for (i = 0; i < n / 2; ++i) {
    const V* x = k->v + i;
    k->fine[2 * i] = x[0];
    k->fine[2 * i + 1] =
        (3.0 * (x[-2] + x[3]) - 25.0 * (x[-1] + x[2]) + 150.0 * (x[0] + x[1])) / 256.0;
  }
  for (i = 0; i < n; ++i) k->v[i] = pick(k->fine[i] - k->fine[i] == all(0.0), k->fine[i], all(0.0));
}

/* Newton's steps until the last is a small share of v, or they do not die out: where they have. */
static Bits settle(Work* k, const V* robot, long long n, V h, double share, int steps) {
  V damp = all(1.0), before = all(INFINITY), out[5];
  Bits settled = {0}, going = ~settled;
  long long i;
  while (steps-- && any(going)) {
    V size = all(0.0), top = size, decay;
    for (i = 0; i < n; ++i) {
      motion(k->v[i], robot, k, i, out);
      k->a[i] = out[1];
      k->b[i] = out[0] - out[1] * k->v[i];
    }
    decay = march(k, n, h, k->fine);
    for (i = 0; i < n; ++i) {
      size = v_max(v_abs(k->fine[i] - k->v[i]), size);
      top = v_max(v_abs(k->v[i]), top);
    }
    damp = pick(size > 0.9 * before, damp / 2.0, v_min(1.5 * damp, all(1.0)));
    for (i = 0; i < n; ++i)
      k->v[i] = pick(going, k->v[i] + damp * (k->fine[i] - k->v[i]), k->v[i]);
    settled |= going & (size <= share * top) & (decay < all(-1e-9));
    going &= ~settled & (size - size == all(0.0)) & (damp > all(1e-3));
    before = size;
  }
  return settled;
}

/* speed, turn, peak torque and the largest |v|, of the v that was found. */
static void results_of(Work* k, const V* robot, long long n, V h, int straight, V* results) {
  V out[5], vx = all(0.0), vy = vx, ex = vx, ey = vx, top = vx, total = vx, chi, drift;
  double each = 1.0 / (double)n;
  long long i;
  for (i = 0; i < n; ++i) {
    motion(k->v[i], robot, k, i, out);
    k->w[i] = out[2];
    k->side[i] = out[3];
    k->torque[i] = out[4];
    top = v_max(v_abs(k->v[i]), top);
  }
  wrap(k->w, n, straight ? -1.0 : 1.0);
  for (i = 0; i < n; ++i) total += over_step(k->w + i);
  total *= h;
  /* The heading less its steady turn repeats, or changes sign after half a period. */
  chi = straight ? -0.5 * total : all(0.0);
  drift = straight ? all(0.0) : total * each;
  for (i = 0; i < n; ++i) {
    V cosine = v_cos(chi), sine = v_sin(chi);
    vx += cosine * k->v[i] - sine * k->side[i];
    vy += sine * k->v[i] + cosine * k->side[i];
    ex += cosine;
    ey += sine;
    chi += h * over_step(k->w + i) - drift;
  }
  if (straight) vy = ey = total = all(0.0);
  results[0] = signed_speed(vx, vy, ex, ey) * each;
  results[1] = total;
  results[2] = peak(k->torque, n);
  results[3] = top;
}

/* By how much, relative, results changed, the peak torque in hundredths. */
static V change(const V* now, const V* before) {
  V scale = v_max(v_abs(now[0]), 1e-3 * now[3]) + 1e-12;
  V speed = v_abs(now[0] - before[0]) / scale;
  V turn = v_abs(now[1] - before[1]) / v_max(v_abs(now[1]), all(1e-3));
  V torque = 1e-2 * v_abs(now[2] - before[2]) / (now[2] + 1e-12);
  return v_max(v_max(speed, turn), torque);
}

/* results: speed, turn, peak torque, error; the error is inf where there is no steady cycle. */
static void newton_block(const Points* points, const double* sine, long long first,
                         long long most, int straight, double tolerance, Work* k, V* results) {
  V robot[NK0 + 1], x[3], now[4], before[4], error = all(INFINITY), last_change = all(0.0);
  V omega = 2.0 * PI / points->period, span = straight ? points->period / 2.0 : points->period;
  Bits resolved = {0}, before_settled = {0};
  long long n, i, quarter = straight ? most / 2 : most / 4;
  int c;
  rr_0(points->p, robot);
  for (c = 0; c < 4; ++c) results[c] = before[c] = all(NAN);
  results[3] = all(INFINITY);
  for (n = first; n <= most && any(~resolved); n *= 2) {
    V h = span / (double)n, rough = all(0.0), seen;
    double last = 1e-4;
    Bits settled, better;
    for (i = 0; i < n; ++i) {
      long long at = i * (most / n);
      V swing = points->amplitude * sine[at];
      x[0] = swing + points->offset;
      x[1] = points->amplitude * omega * sine[at + quarter];
      x[2] = -swing * omega * omega;
      rr_1(x, robot, k->kept + NK1 * i);
    }
    if (n == first)
      begin(k, robot, n, h);
    else
      refine(k, n);
    for (i = 0; i < L; ++i)
      if (!resolved[i] && error[i] < INFINITY) rough[i] = error[i];
    /* What will not be the last need not be so close. */
    for (i = 0; i < L; ++i)
      if (rough[i] > 0 && 1e-3 * rough[i] < last) last = 1e-3 * rough[i];
    if (last < 1e-2 * tolerance) last = 1e-2 * tolerance;
    settled = settle(k, robot, n, h, last, n == first ? 12 : 25);
    results_of(k, robot, n, h, straight, now);
    /* One small change may be chance, as samples fall beside or into a sudden turn of friction:
       so the change before it counts too, by the quarter that a doubling leaves at most of it. */
    seen = change(now, before);
    better = settled & before_settled;
    x[0] = pick(better, seen, all(0.0));
    seen = v_max(seen, last_change / 4.0);
    last_change = x[0];
    better &= ~resolved;
    error = pick(better, seen, error);
    for (c = 0; c < 3; ++c) results[c] = pick(better, now[c], results[c]);
    results[3] = pick(better, seen, results[3]);
    resolved |= better & (seen <= all(tolerance));
    memcpy(before, now, sizeof now);
    before_settled = settled;
  }
}

static V* room(V** next, long long n) {
  V* here = *next + NEAR;
  *next += n + 2 * NEAR;
  return here;
}

/* sine: of most + most/4 phases, of half a period if straight (then most + most/2), else a whole.
   first, most: samples, powers of two. out (4, count) as above. Returns whether there was
   memory. */
int rr_newton(long long count, const double* amplitude, const double* offset,
              const double* period, const long long* which, const double* p, int straight,
              long long first, long long most, double tolerance, const double* sine,
              double* out) {
  Points points;
  Work k;
  V results[4], *memory, *next;
  long long from, size = (NX + 1) * (most + 2 * NEAR);
  int c;
  memory = next = aligned_alloc(sizeof(V), sizeof(V) * size);
  if (!memory) return 0;
  k.v = room(&next, most), k.a = room(&next, most), k.b = room(&next, most);
  k.gain = room(&next, most), k.inverse = room(&next, most), k.shift = room(&next, most);
  k.side = room(&next, most), k.w = room(&next, most), k.torque = room(&next, most);
  k.fine = room(&next, most), k.kept = next;
  for (from = 0; from < count; from += L) {
    gather(&points, from, count, amplitude, offset, period, which, p);
    newton_block(&points, sine, first, most, straight, tolerance, &k, results);
    for (c = 0; c < 4; ++c) scatter(from, count, results[c], out + c * count);
  }
  free(memory);
  return 1;
}
