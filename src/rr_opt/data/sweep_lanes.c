/* Numbers of L points at a time, and the mathematics of them: from glibc's vector library where
   it is there, one by one elsewhere. */

#include <math.h>
#include <stdlib.h>
#include <string.h>

#if defined(__AVX512F__)
#define L 8
#elif defined(__AVX2__)
#define L 4
#else
#define L 2
#endif

#define INLINE static inline __attribute__((always_inline))
#define PI 3.14159265358979323846

typedef double V __attribute__((vector_size(8 * L)));
typedef long long Bits __attribute__((vector_size(8 * L)));

INLINE V all(double x) {
  V v;
  int l;
  for (l = 0; l < L; ++l) v[l] = x;
  return v;
}

INLINE V pick(Bits which, V a, V b) { return (V)((which & (Bits)a) | (~which & (Bits)b)); }
INLINE V v_abs(V x) { return pick(x < all(0.0), -x, x); }
INLINE V v_min(V a, V b) { return pick(a < b, a, b); }
INLINE V v_max(V a, V b) { return pick(a > b, a, b); }
INLINE V v_sign(V x) {
  return pick(x > all(0.0), all(1.0), pick(x < all(0.0), all(-1.0), x));
}

#define ONE_BY_ONE(name)                         \
  INLINE V v_##name(V x) {                       \
    int l;                                       \
    for (l = 0; l < L; ++l) x[l] = name(x[l]);   \
    return x;                                    \
  }

#if defined(__x86_64__) && defined(__GLIBC__) && L > 2
#if L == 8
#define OF_GLIBC(name)          \
  extern V _ZGVeN8v_##name(V);  \
  INLINE V v_##name(V x) { return _ZGVeN8v_##name(x); }
#else
#define OF_GLIBC(name)          \
  extern V _ZGVdN4v_##name(V);  \
  INLINE V v_##name(V x) { return _ZGVdN4v_##name(x); }
#endif
OF_GLIBC(sin)
OF_GLIBC(cos)
OF_GLIBC(exp)
OF_GLIBC(log)
#if __GLIBC_PREREQ(2, 35)
OF_GLIBC(tanh)
OF_GLIBC(tan)
#else
ONE_BY_ONE(tanh)
ONE_BY_ONE(tan)
#endif
#else
ONE_BY_ONE(sin)
ONE_BY_ONE(cos)
ONE_BY_ONE(exp)
ONE_BY_ONE(log)
ONE_BY_ONE(tanh)
ONE_BY_ONE(tan)
#endif
ONE_BY_ONE(sqrt)

INLINE V v_pow(V x, V y) {
  int l;
  for (l = 0; l < L; ++l) x[l] = pow(x[l], y[l]);
  return x;
}

INLINE V v_atan2(V y, V x) {
  int l;
  for (l = 0; l < L; ++l) y[l] = atan2(y[l], x[l]);
  return y;
}

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
