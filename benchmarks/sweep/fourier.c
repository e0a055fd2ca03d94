/* The practical limit: the Fourier steady state of the viscous robot by hand, for speed alone.

   Eight points at a time; the compiler makes vectors of the loops over them. N nodes a period are
   known when this is compiled. y = v exp(-A) obeys dy/dt = mean y + f exp(-A). */

#include <math.h>
#include <string.h>

#define B 8
#define PI 3.14159265358979323846
#define FOR for (l = 0; l < B; ++l)

#if defined(__x86_64__) && defined(__GLIBC__)
__attribute__((simd("notinbranch"))) double sin(double);
__attribute__((simd("notinbranch"))) double cos(double);
__attribute__((simd("notinbranch"))) double exp(double);
#endif

static double integral[N][N], forward[N][N], back[N][N], sine[N], cosine[N];
static int ready;

static void prepare(void) {
  int i, j, k;
  for (i = 0; i < N; ++i) {
    sine[i] = sin(2 * PI * i / N);
    cosine[i] = cos(2 * PI * i / N);
    for (j = 0; j < N; ++j) {
      integral[i][j] = 0;
      for (k = 1; k < N / 2; ++k)
        integral[i][j] += sin(2 * PI * k * (i - j) / N) / (PI * k * N);
      k = i <= N / 2 ? i : i - N / 2;
      forward[i][j] = i <= N / 2 ? cos(2 * PI * k * j / N) : -sin(2 * PI * k * j / N);
    }
  }
  for (i = 0; i < N; ++i)
    for (j = 0; j < N; ++j) back[j][i] = forward[i][j] * (i == 0 || i == N / 2 ? 1.0 : 2.0) / N;
  ready = 1;
}

static void apply(const double m[N][N], double x[N][B], double y[N][B]) {
  int i, j, l;
  for (i = 0; i < N; i += 4) {
    double s0[B] = {0}, s1[B] = {0}, s2[B] = {0}, s3[B] = {0};
    for (j = 0; j < N; ++j) FOR {
        s0[l] += m[i][j] * x[j][l];
        s1[l] += m[i + 1][j] * x[j][l];
        s2[l] += m[i + 2][j] * x[j][l];
        s3[l] += m[i + 3][j] * x[j][l];
      }
    memcpy(y[i], s0, sizeof s0);
    memcpy(y[i + 1], s1, sizeof s1);
    memcpy(y[i + 2], s2, sizeof s2);
    memcpy(y[i + 3], s3, sizeof s3);
  }
}

/* p (12, count) as Work.parameters, out (count): |speed|; count a multiple of B. */
void speeds(long long count, const double* alpha, const double* T, const double* phi0,
            const double* p, double* out) {
  long long from;
  int i, k, l;
  if (!ready) prepare();
  for (from = 0; from < count; from += B) {
    double a[N][B], f[N][B], E[N][B], y[N][B], w[N][B], w0[N][B], mean[B], turn[B], omega[B];
    double vx[B], vy[B], P[12][B], al[B], off[B];
    FOR {
      al[l] = alpha[from + l], off[l] = phi0[from + l];
      omega[l] = 2 * PI / T[from + l], mean[l] = turn[l] = vx[l] = vy[l] = 0;
      for (i = 0; i < 12; ++i) P[i][l] = p[i * count + from + l];
    }
    for (i = 0; i < N; ++i) FOR {
        double m1 = P[0][l], J1 = P[1][l], ma1 = P[2][l], c1 = P[3][l], b1 = P[4][l], k1 = P[5][l];
        double m2 = P[6][l], J2 = P[7][l], ma2 = P[8][l], c2 = P[9][l], b2 = P[10][l];
        double k2 = P[11][l], swing = al[l] * sine[i], phi = swing + off[l];
        double q = al[l] * omega[l] * cosine[i], r = -swing * omega[l] * omega[l];
        double s = sin(phi), c = cos(phi), S1 = c1 * c + c2, S2 = c1 + c2 * c, I = 1 / S1;
        double ss = s * s, lever = c1 * c1 - c2 * c2, j = J1 + J2 + m2 * lever, qs = q * s;
        double g = -1 / ((m1 + m2) * S1 * S1 + j * ss);
        double d1 = 2 * k1 * b1 * b1, d2 = 2 * k2 * b2 * b2;
        a[i][l] = g * (qs * (j * I * S2 + ma1 * c2 + ma2 * c1) +
                       (d1 + d2 + 2 * k2 * lever) * ss + 2 * (k1 + k2) * S1 * S1);
        f[i][l] = g * (r * s * (J1 * c2 - J2 * c1 * c + m2 * c1 * c2 * S2) +
                       q * q * (c1 * c2 * (j * ss * I + m2 * S1) + ma1 * c2 * c2 - ma2 * c1 * c1 * c) +
                       qs * (d1 * c2 - d2 * c1 * c + 2 * k2 * c1 * c2 * S2));
        w[i][l] = -I * s;
        w0[i][l] = -I * c2 * q;
        mean[l] += a[i][l] / N;
      }
    apply(integral, a, E);
    for (i = 0; i < N; ++i) FOR {
        E[i][l] = exp(E[i][l] * 2 * PI / omega[l]);
        f[i][l] /= E[i][l];
      }
    apply(forward, f, y);
    for (k = 0; k <= N / 2; ++k) FOR {
        double wave = omega[l] * k, size = 1 / (mean[l] * mean[l] + wave * wave), c = y[k][l];
        int other = k > 0 && k < N / 2 ? N / 2 + k : k;
        double s = other > k ? y[other][l] : 0;
        y[k][l] = (wave * s - mean[l] * c) * size;
        if (other > k) y[other][l] = -(mean[l] * s + wave * c) * size;
      }
    apply(back, y, f);
    for (i = 0; i < N; ++i) FOR {
        f[i][l] *= E[i][l];
        w[i][l] = w[i][l] * f[i][l] + w0[i][l];
      }
    apply(integral, w, E);
    for (i = 0; i < N; ++i) FOR {
        double chi = E[i][l] * 2 * PI / omega[l], c = cos(chi), s = sin(chi);
        double side = -P[3][l] * w[i][l];
        vx[l] += c * f[i][l] - s * side;
        vy[l] += s * f[i][l] + c * side;
      }
    FOR out[from + l] = sqrt(vx[l] * vx[l] + vy[l] * vy[l]) / N;
  }
}
