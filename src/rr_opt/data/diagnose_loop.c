/* The loops over the steps of a run, around the functions that CasADi has written above:
   rr_step(state, inputs, p), rr_rates and rr_seen(state, drive, p), the last two with their
   dense Jacobian, column by column, by state, drive and p. Arrays of the caller are row by row. */

#include <stdlib.h>
#include <string.h>

#define COLUMNS (NX + ND + NP)

void rr_predict(long long steps, long long each, const double* inputs, const double* at,
                const double* p, double* states, double* seen_out) {
  double work[NW_WORK + 1];
  casadi_int iwork[NI_WORK + 1];
  double* res[2] = {0, 0};
  long long k;
  for (k = 0; k < steps; ++k) {
    const double* arg[3] = {states + k * NX, inputs + k * (1 + 3 * ND), p};
    res[0] = states + (k + 1) * NX;
    rr_step(arg, res, iwork, work, 0);
  }
  for (k = 0; k <= steps / each; ++k) {
    const double* arg[3] = {states + k * each * NX, at + k * ND, p};
    res[0] = seen_out + k * NY;
    rr_seen(arg, res, iwork, work, 0);
  }
}

/* What is asked for: sparse derivatives of p, and of the drive where it moves. */
typedef struct {
  long long nw, entries;
  const long long *row, *column;
  const double* value;
} Wanted;

/* force (rows, nw) = by_p @ wanted + by_drive @ moved, from a Jacobian of so many rows. */
static void forced(const double* jacobian, int rows, const Wanted* wanted, const double* moved,
                   double* force) {
  long long e, w;
  int i, d;
  memset(force, 0, sizeof(double) * rows * wanted->nw);
  for (e = 0; e < wanted->entries; ++e)
    for (i = 0; i < rows; ++i)
      force[i * wanted->nw + wanted->column[e]] +=
          jacobian[(NX + ND + wanted->row[e]) * rows + i] * wanted->value[e];
  if (moved)
    for (i = 0; i < rows; ++i)
      for (d = 0; d < ND; ++d)
        for (w = 0; w < wanted->nw; ++w)
          force[i * wanted->nw + w] += jacobian[(NX + d) * rows + i] * moved[d * wanted->nw + w];
}

/* out (NX, n) = fx @ M + [0 | force], n = NX + nw. */
static void slope(const double* jacobian, const double* force, const double* M, long long nw,
                  double* out) {
  long long n = NX + nw, c;
  int i, j;
  for (i = 0; i < NX; ++i) {
    double* row = out + i * n;
    for (c = 0; c < NX; ++c) row[c] = 0;
    memcpy(row + NX, force + i * nw, sizeof(double) * nw);
    for (j = 0; j < NX; ++j) {
      double a = jacobian[j * NX + i];
      if (a != 0)
        for (c = 0; c < n; ++c) row[c] += a * M[j * n + c];
    }
  }
}

/* The classical Runge-Kutta step of the linearised motion. */
static void kutta(const double* first, const double* mid, const double* last, const double* f0,
                  const double* f1, const double* f2, double h, long long nw, double* M,
                  double* room) {
  long long size = NX * (NX + nw), c;
  double *k1 = room, *k2 = room + size, *k3 = room + 2 * size, *k4 = room + 3 * size;
  double* at = room + 4 * size;
  slope(first, f0, M, nw, k1);
  for (c = 0; c < size; ++c) at[c] = M[c] + h / 2 * k1[c];
  slope(mid, f1, at, nw, k2);
  for (c = 0; c < size; ++c) at[c] = M[c] + h / 2 * k2[c];
  slope(mid, f1, at, nw, k3);
  for (c = 0; c < size; ++c) at[c] = M[c] + h * k3[c];
  slope(last, f2, at, nw, k4);
  for (c = 0; c < size; ++c) M[c] += h / 6 * (k1[c] + 2 * (k2[c] + k3[c]) + k4[c]);
}

/* A step with the matrix z = h fx of its middle: (1 - 2z/3 + z^2/6)^-1 (1 + z/3), which damps. */
static void frozen(const double* mid, const double* force, double h, long long nw, double* M,
                   double* room) {
  long long n = NX + nw, c;
  double z[NX][NX], left[NX][NX];
  int i, j, k;
  for (i = 0; i < NX; ++i)
    for (j = 0; j < NX; ++j) z[i][j] = h * mid[j * NX + i];
  for (i = 0; i < NX; ++i)
    for (j = 0; j < NX; ++j) {
      double square = 0;
      for (k = 0; k < NX; ++k) square += z[i][k] * z[k][j];
      left[i][j] = (i == j) - 2.0 / 3 * z[i][j] + square / 6;
    }
  for (i = 0; i < NX; ++i) {
    double* row = room + i * n;
    memcpy(row, M + i * n, sizeof(double) * n);
    for (c = 0; c < nw; ++c) row[NX + c] += h * force[i * nw + c];
    for (j = 0; j < NX; ++j) {
      for (c = 0; c < n; ++c) row[c] += z[i][j] / 3 * M[j * n + c];
      for (c = 0; c < nw; ++c) row[NX + c] -= z[i][j] / 6 * h * force[j * nw + c];
    }
  }
  for (k = 0; k < NX; ++k) {
    int pivot = k;
    for (i = k + 1; i < NX; ++i)
      if (left[i][k] * left[i][k] > left[pivot][k] * left[pivot][k]) pivot = i;
    if (pivot != k) {
      for (j = 0; j < NX; ++j) {
        double swap = left[k][j];
        left[k][j] = left[pivot][j];
        left[pivot][j] = swap;
      }
      for (c = 0; c < n; ++c) {
        double swap = room[k * n + c];
        room[k * n + c] = room[pivot * n + c];
        room[pivot * n + c] = swap;
      }
    }
    for (i = 0; i < NX; ++i) {
      double factor = left[i][k] / left[k][k];
      if (i == k || factor == 0) continue;
      for (j = k; j < NX; ++j) left[i][j] -= factor * left[k][j];
      for (c = 0; c < n; ++c) room[i * n + c] -= factor * room[k * n + c];
    }
  }
  for (i = 0; i < NX; ++i)
    for (c = 0; c < n; ++c) M[i * n + c] = room[i * n + c] / left[i][i];
}

void rr_slopes(long long steps, long long each, long long nw, long long entries, long long moves,
               const double* inputs, const double* at, const double* p, const double* states,
               const long long* row, const long long* column, const double* value,
               const double* moved_at, const double* moved_middle, double* out) {
  Wanted wanted = {nw, entries, row, column, value};
  long long n = NX + nw, wide = NX > NY ? NX : NY, k, c, sample = 0;
  double work[NW_WORK + 1], here[NX * COLUMNS], next[NX * COLUMNS], mid[NX * COLUMNS];
  double shown[NY * COLUMNS], value0[NX], value1[NX], ignored[NX + NY];
  casadi_int iwork[NI_WORK + 1];
  double* room = calloc(6 * NX * n + 3 * wide * nw + 1, sizeof(double));
  double *M = room, *f0 = room + 6 * NX * n, *f1 = f0 + wide * nw, *f2 = f1 + wide * nw;
  int i, j;
  if (!room) return;
  for (i = 0; i < NX; ++i) M[i * n + i] = 1;
  if (each == 1 && steps > 0) {
    const double* arg[3] = {states, inputs + 1, p};
    double* res[2] = {value0, here};
    rr_rates(arg, res, iwork, work, 0);
    forced(here, NX, &wanted, moves ? moved_at : 0, f0);
  }
  for (k = 0; k <= steps; ++k) {
    const double* x = states + k * NX;
    const double* in = inputs + k * (1 + 3 * ND);
    if (k % each == 0) {
      const double* arg[3] = {x, at + sample * ND, p};
      double* res[2] = {ignored, shown};
      double* to = out + sample * NY * n;
      const double* moved = moves ? moved_at + sample * ND * nw : 0;
      rr_seen(arg, res, iwork, work, 0);
      forced(shown, NY, &wanted, moved, f2);
      for (i = 0; i < NY; ++i) {
        for (c = 0; c < NX; ++c) to[i * n + c] = 0;
        memcpy(to + i * n + NX, f2 + i * nw, sizeof(double) * nw);
        for (j = 0; j < NX; ++j)
          if (shown[j * NY + i] != 0)
            for (c = 0; c < n; ++c) to[i * n + c] += shown[j * NY + i] * M[j * n + c];
      }
      ++sample;
    }
    if (k == steps) break;
    {
      double h = in[0], middle[NX];
      const double* between = moves ? moved_middle + k * ND * nw : 0;
      const double* arg[3] = {middle, in + 1 + ND, p};
      double* res[2] = {ignored, mid};
      if (each == 1) {
        const double* arg_end[3] = {x + NX, k + 1 < steps ? in + 2 + 3 * ND : in + 1 + 2 * ND, p};
        double* res_end[2] = {value1, next};
        rr_rates(arg_end, res_end, iwork, work, 0);
        forced(next, NX, &wanted, moves ? moved_at + (k + 1) * ND * nw : 0, f2);
        for (i = 0; i < NX; ++i)
          middle[i] = (x[i] + x[NX + i]) / 2 + h / 8 * (value0[i] - value1[i]);
        rr_rates(arg, res, iwork, work, 0);
        forced(mid, NX, &wanted, between, f1);
        kutta(here, mid, next, f0, f1, f2, h, nw, M, room + NX * n);
        memcpy(here, next, sizeof here);
        memcpy(value0, value1, sizeof value0);
        memcpy(f0, f2, sizeof(double) * NX * nw);
      } else {
        for (i = 0; i < NX; ++i) middle[i] = (x[i] + x[NX + i]) / 2;
        rr_rates(arg, res, iwork, work, 0);
        forced(mid, NX, &wanted, between, f1);
        frozen(mid, f1, h, nw, M, room + NX * n);
      }
    }
  }
  free(room);
}
