/* L points, of which the last may stand there more than once. */
typedef struct {
  V amplitude, offset, period, p[NP];
} Points;

/* point k has the parameters p[which[k]]; robots one after the other, NP each. */
static void gather(Points* points, long long from, long long count, const double* amplitude,
                   const double* offset, const double* period, const long long* which,
                   const double* p) {
  long long k;
  int l, i;
  for (l = 0; l < L; ++l) {
    k = from + l < count ? from + l : count - 1;
    points->amplitude[l] = amplitude[k];
    points->offset[l] = offset[k];
    points->period[l] = period[k];
    for (i = 0; i < NP; ++i) points->p[i][l] = p[which[k] * NP + i];
  }
}

static void scatter(long long from, long long count, V value, double* out) {
  int l;
  for (l = 0; l < L && from + l < count; ++l) out[from + l] = value[l];
}

/* Signed mean speed from the means of P's velocity and of the heading, in the frame that turns
   with the gait. */
static V signed_speed(V vx, V vy, V ex, V ey) {
  V size = v_sqrt(vx * vx + vy * vy);
  return pick(vx * ex + vy * ey < all(0.0), -size, size);
}

/* Largest of n samples of |x|, which repeat, by a parabola through the largest and its two
   neighbours. */
static V peak(const V* x, long long n) {
  V top = v_abs(x[0]), left, right, bend, rise;
  Bits at = {0};
  long long i;
  int l;
  for (i = 1; i < n; ++i) {
    V here = v_abs(x[i]);
    Bits more = here > top;
    top = v_max(here, top);
    at = (more & i) | (~more & at);
  }
  for (l = 0; l < L; ++l) {
    left[l] = fabs(x[(at[l] + n - 1) % n][l]);
    right[l] = fabs(x[(at[l] + 1) % n][l]);
  }
  bend = left - 2.0 * top + right;
  rise = right - left;
  return top - pick(bend < all(0.0), rise * rise / (8.0 * bend), all(0.0));
}
