/* Predict runs, and linearise them, L of them side by side.

   Around functions of a system that were written above:
     step_1(x, kept, out)    a step's end; x is the state and behind it the step's inputs: its length
                             and the drive at its beginning, middle and end
     rates_1(x, kept, out)   d(state)/dt, and the nonzeros of its derivatives; x is the state and
                             behind it the drive
     seen_1(x, kept, out)    what is seen, and the nonzeros of its derivatives; x as for the rates
   each after NAME_0(p, kept), which is what they need of p alone. The derivatives' nonzeros come
   column by column: of the state, of the drive, of p. RATES_ROW, RATES_COLUMN, SEEN_ROW and
   SEEN_COLUMN say where they stand; RX, RD and RP how many there are of each for the rates, SX, SD
   and SP for what is seen. */

#define NODE (1 + 3 * ND)

/* What dry friction forgets of the start falls below 1e-308, where processors of this kind are a
   hundred times slower: there it is 0. */
#if defined(__SSE__)
#define FORGETS unsigned before_ = __builtin_ia32_stmxcsr(); __builtin_ia32_ldmxcsr(before_ | 0x8040)
#define REMEMBERS __builtin_ia32_ldmxcsr(before_)
#else
#define FORGETS
#define REMEMBERS
#endif

/* A run of `steps` steps; arrays of the caller, row by row.

   inputs (steps, NODE);  at (samples, ND) the drive at the samples;  p (NP)
   states (steps + 1, NX), of which the first is given;  seen (samples, NY)
   value (entries)         the entries of dp/dq
   moved_at (samples, ND, moves), moved (steps, 3, ND, moves)   of d(drive)/dq, its columns that
                           are not zero; the second at the beginning, middle and end of the steps
   data, weight (samples, NY)   what was recorded, and 1/sigma, 0 where nothing was
   more (samples, NY, extras)   further columns
   gram (n, n)             the result: J'J over all samples, J = [d/dstart | d/dq | more | off]
   end (NX, NX + nq)       the derivatives of the last state by the start and by q */
typedef struct {
  long long steps;
  const double *inputs, *at, *p;
  double *states, *seen;
  const double *value, *moved_at, *moved, *data, *weight, *more;
  double *gram, *end;
} Run;

/* What is asked for: how many q, the entries of dp/dq (those of row i are first[i] .. first[i + 1],
   each with its column), and the columns of q that move the drive. */
typedef struct {
  long long nq, entries, moves, extras;
  const long long *first, *column, *move;
} Asked;

/* Some runs, one in each lane; the last may stand in several. */
typedef struct {
  const Run* of[L];
  long long own, most;
  V step_kept[K_STEP + 1], rates_kept[K_RATES + 1], seen_kept[K_SEEN + 1];
} Group;

static void group_of(const Run* runs, long long from, long long count, Group* group) {
  V p[NP + 1];
  int l, i;
  group->own = count - from < L ? count - from : L;
  group->most = 0;
  for (l = 0; l < L; ++l) {
    const Run* run = runs + (l < group->own ? from + l : count - 1);
    group->of[l] = run;
    if (run->steps > group->most) group->most = run->steps;
    for (i = 0; i < NP; ++i) p[i][l] = run->p[i];
  }
  step_0(p, group->step_kept);
  rates_0(p, group->rates_kept);
  seen_0(p, group->seen_kept);
}

/* The length and drive of step k; of a run that has ended, a step of no length. */
static void step_inputs(const Group* group, long long k, V* in) {
  int l, i;
  for (l = 0; l < L; ++l) {
    const Run* run = group->of[l];
    const double* from = run->inputs + (k < run->steps ? k : run->steps - 1) * NODE;
    for (i = 0; i < NODE; ++i) in[i][l] = from[i];
    if (k >= run->steps) in[0][l] = 0.0;
  }
}

/* Which sample of its run lane l is at after k steps, and whether there is one. */
INLINE int at_sample(const Group* group, int l, long long k, long long each, long long* sample) {
  int there = k <= group->of[l]->steps;
  *sample = (there ? k : group->of[l]->steps) / each;
  return there;
}

static void drive_at(const Group* group, long long k, long long each, V* x) {
  long long sample;
  int l, i;
  for (l = 0; l < L; ++l) {
    at_sample(group, l, k, each, &sample);
    for (i = 0; i < ND; ++i) x[i][l] = group->of[l]->at[sample * ND + i];
  }
}

/* Runs that go side by side. */
long long rr_lanes(void) { return L; }

void rr_predict(long long count, const Run* runs, long long each) {
  long long from, k, sample;
  FORGETS;
  for (from = 0; from < count; from += L) {
    Group group;
    V x[NX + NODE], at[NX + ND], out[NX + RX + RD + RP + NY + SX + SD + SP];
    int l, i;
    group_of(runs, from, count, &group);
    for (l = 0; l < L; ++l)
      for (i = 0; i < NX; ++i) x[i][l] = group.of[l]->states[i];
    for (k = 0; k <= group.most; ++k) {
      if (k % each == 0) {
        for (i = 0; i < NX; ++i) at[i] = x[i];
        drive_at(&group, k, each, at + NX);
        seen_1(at, group.seen_kept, out);
        for (l = 0; l < group.own; ++l)
          if (at_sample(&group, l, k, each, &sample))
            for (i = 0; i < NY; ++i) group.of[l]->seen[sample * NY + i] = out[i][l];
      }
      if (k == group.most) break;
      step_inputs(&group, k, x + NX);
      step_1(x, group.step_kept, out);
      for (i = 0; i < NX; ++i) x[i] = out[i];
      for (l = 0; l < group.own; ++l)
        if (k < group.of[l]->steps)
          for (i = 0; i < NX; ++i) group.of[l]->states[(k + 1) * NX + i] = x[i][l];
    }
  }
  REMEMBERS;
}

/* Room for a group: M (NX, n) the derivatives of the state, n = NX + nq; four slopes of it; the
   rows of J at a sample (NY, wide); and J'J, its upper triangle row by row. */
typedef struct {
  V *M, *at, *K[4], *force, *J, *S, *value, *moved;
  long long n, wide;
  void* all;
} Room;

static int room_for(const Asked* asked, Room* room) {
  long long n = NX + asked->nq, wide = n + asked->extras + 1, k;
  long long size = 6 * NX * n + (NX > NY ? NX : NY) * asked->nq + NY * wide +
                   wide * (wide + 1) / 2 + asked->entries + ND * asked->moves + 1;
  V* next;
  room->all = aligned_alloc(sizeof(V), size * sizeof(V));
  if (!room->all) return 0;
  memset(room->all, 0, size * sizeof(V));
  room->n = n;
  room->wide = wide;
  next = room->all;
  room->M = next, next += NX * n;
  room->at = next, next += NX * n;
  for (k = 0; k < 4; ++k) room->K[k] = next, next += NX * n;
  room->force = next, next += (NX > NY ? NX : NY) * asked->nq;
  room->J = next, next += NY * wide;
  room->S = next, next += wide * (wide + 1) / 2;
  room->value = next, next += asked->entries;
  room->moved = next;
  return 1;
}

/* How the drive changes: at `place` rows from the beginning of each run's array. */
static void moved_at(const Group* group, const Asked* asked, int within, const long long* place,
                     V* moved) {
  long long c, size = ND * asked->moves;
  int l;
  for (l = 0; l < L; ++l) {
    const Run* run = group->of[l];
    const double* from = (within ? run->moved : run->moved_at) + place[l] * size;
    for (c = 0; c < size; ++c) moved[c][l] = from[c];
  }
}

/* force (rows, nq) = by_p dp/dq + by_drive d(drive)/dq, from the nonzeros of all derivatives. */
static void forced(const V* by, const int* row, const int* column, int skip, int nd, int np,
                   int rows, const Asked* asked, const V* moved, const V* value, V* force) {
  long long e, c;
  int k;
  memset(force, 0, sizeof(V) * rows * asked->nq);
  for (k = skip; k < skip + nd; ++k)
    for (c = 0; c < asked->moves; ++c)
      force[row[k] * asked->nq + asked->move[c]] +=
          by[k] * moved[(column[k] - NX) * asked->moves + c];
  for (k = skip + nd; k < skip + nd + np; ++k)
    for (e = asked->first[column[k] - NX - ND]; e < asked->first[column[k] - NX - ND + 1]; ++e)
      force[row[k] * asked->nq + asked->column[e]] += by[k] * value[e];
}

/* out (NX, n) = fx M + [0 | force]. */
static void slope(const V* by, const Asked* asked, const Room* room, const V* M, V* out) {
  long long n = room->n, c;
  int i, k;
  for (i = 0; i < NX; ++i) {
    memset(out + i * n, 0, sizeof(V) * NX);
    memcpy(out + i * n + NX, room->force + i * asked->nq, sizeof(V) * asked->nq);
  }
  for (k = 0; k < RX; ++k) {
    V* to = out + RATES_ROW[k] * n;
    const V *from = M + RATES_COLUMN[k] * n, a = by[k];
    for (c = 0; c < n; ++c) to[c] += a * from[c];
  }
}

/* The linearised rates at a node (0, 1, 2) of step k, at the state x: `out` has what they are and
   their derivatives, and the room the force. */
static void linear(const Group* group, const Asked* asked, const Room* room, long long k, int node,
                   const V* in, const V* x, V* out) {
  V at[NX + ND];
  long long place[L];
  int i, l;
  for (i = 0; i < NX; ++i) at[i] = x[i];
  for (i = 0; i < ND; ++i) at[NX + i] = in[1 + node * ND + i];
  for (l = 0; l < L; ++l) {
    long long last = group->of[l]->steps - 1;
    place[l] = 3 * (k < last ? k : last) + node;
  }
  rates_1(at, group->rates_kept, out);
  if (asked->moves) moved_at(group, asked, 1, place, room->moved);
  forced(out + NX, RATES_ROW, RATES_COLUMN, RX, RD, RP, NX, asked, room->moved, room->value,
         room->force);
}

INLINE void reach(const Room* room, V h, const V* K) {
  long long c;
  for (c = 0; c < NX * room->n; ++c) room->at[c] = room->M[c] + h * K[c];
}

INLINE void arrive(const Room* room, V h) {
  long long c;
  for (c = 0; c < NX * room->n; ++c)
    room->M[c] += h / 6.0 * (room->K[0][c] + 2.0 * (room->K[1][c] + room->K[2][c]) + room->K[3][c]);
}

#ifdef STIFF

/* A step with the matrix z = h fx of its middle: (1 - 2z/3 + z^2/6)^-1 (1 + z/3), which damps. */
static void linear_step(const Group* group, const Asked* asked, const Room* room, long long k,
                        long long each, const V* in, const V* x, const V* end) {
  V middle[NX], out[NX + RX + RD + RP], z[NX][NX], left[NX][NX], scale;
  long long n = room->n, c;
  int i, j, m;
  V *M = room->M, *to = room->K[1];
  (void)each;
  for (i = 0; i < NX; ++i) middle[i] = (x[i] + end[i]) / 2.0;
  linear(group, asked, room, k, 1, in, middle, out);
  memset(z, 0, sizeof z);
  for (m = 0; m < RX; ++m) z[RATES_ROW[m]][RATES_COLUMN[m]] = in[0] * out[NX + m];
  for (i = 0; i < NX; ++i)
    for (j = 0; j < NX; ++j) {
      V square = all(0.0);
      for (m = 0; m < NX; ++m) square += z[i][m] * z[m][j];
      left[i][j] = all(i == j ? 1.0 : 0.0) - 2.0 / 3.0 * z[i][j] + square / 6.0;
    }
  memcpy(to, M, sizeof(V) * NX * n);
  for (i = 0; i < NX; ++i)
    for (c = 0; c < asked->nq; ++c) to[i * n + NX + c] += in[0] * room->force[i * asked->nq + c];
  for (m = 0; m < RX; ++m) {
    const V a = z[RATES_ROW[m]][RATES_COLUMN[m]], third = a / 3.0, sixth = a * in[0] / 6.0;
    const V *from = M + RATES_COLUMN[m] * n, *force = room->force + RATES_COLUMN[m] * asked->nq;
    V* row = to + RATES_ROW[m] * n;
    for (c = 0; c < n; ++c) row[c] += third * from[c];
    for (c = 0; c < asked->nq; ++c) row[NX + c] -= sixth * force[c];
  }
  /* No pivots are looked for: what settles makes the diagonal large, the rest is near 1. */
  for (m = 0; m < NX; ++m) {
    scale = 1.0 / left[m][m];
    for (j = m; j < NX; ++j) left[m][j] *= scale;
    for (c = 0; c < n; ++c) to[m * n + c] *= scale;
    for (i = 0; i < NX; ++i) {
      const V factor = left[i][m];
      if (i == m || !any(factor != all(0.0))) continue;
      for (j = m; j < NX; ++j) left[i][j] -= factor * left[m][j];
      for (c = 0; c < n; ++c) to[i * n + c] -= factor * to[m * n + c];
    }
  }
  memcpy(M, to, sizeof(V) * NX * n);
}

#else

/* The derivative of a step: of a fine one by the midpoint rule along its chord, of others of the
   classical Runge-Kutta step itself, whose stages' rates are worked out with their derivatives. */
static void linear_step(const Group* group, const Asked* asked, const Room* room, long long k,
                        long long each, const V* in, const V* x, const V* end) {
  static const int NODES[4] = {0, 1, 1, 2};
  static const double REACH[4] = {0.0, 0.5, 0.5, 1.0};
  V at[NX], out[NX + RX + RD + RP];
  long long c;
  int i, stage;
  if (each >= FINE) {
    for (i = 0; i < NX; ++i) at[i] = (x[i] + end[i]) / 2.0;
    linear(group, asked, room, k, 1, in, at, out);
    slope(out + NX, asked, room, room->M, room->K[0]);
    reach(room, in[0] / 2.0, room->K[0]);
    slope(out + NX, asked, room, room->at, room->K[1]);
    for (c = 0; c < NX * room->n; ++c) room->M[c] += in[0] * room->K[1][c];
    return;
  }
  for (i = 0; i < NX; ++i) at[i] = x[i];
  for (stage = 0; stage < 4; ++stage) {
    V h = REACH[stage] * in[0];
    if (stage) {
      for (i = 0; i < NX; ++i) at[i] = x[i] + h * out[i];
      reach(room, h, room->K[stage - 1]);
    }
    linear(group, asked, room, k, NODES[stage], in, at, out);
    slope(out + NX, asked, room, stage ? room->at : room->M, room->K[stage]);
  }
  arrive(room, in[0]);
}

#endif

/* A prediction that has left the numbers says nothing at this sample, nor in a gap. */
static void leave_out(V* row, long long wide, int l) {
  long long c;
  for (c = 0; c < wide; ++c) row[c][l] = 0.0;
}

/* What a sample adds to J'J: the rows of J by what is seen there. */
static void seen_at(const Group* group, const Asked* asked, const Room* room, long long k,
                    long long each, const V* x) {
  V at[NX + ND], out[NY + SX + SD + SP], weight[NY];
  long long place[L], n = room->n, wide = room->wide, c, b;
  V *row, *S = room->S;
  int i, l, m, there[NY];
  for (i = 0; i < NX; ++i) at[i] = x[i];
  drive_at(group, k, each, at + NX);
  seen_1(at, group->seen_kept, out);
  for (l = 0; l < L; ++l) {
    int seen = at_sample(group, l, k, each, place + l);
    for (i = 0; i < NY; ++i)
      weight[i][l] = seen ? group->of[l]->weight[place[l] * NY + i] : 0.0;
  }
  if (asked->moves) moved_at(group, asked, 0, place, room->moved);
  forced(out + NY, SEEN_ROW, SEEN_COLUMN, SX, SD, SP, NY, asked, room->moved, room->value,
         room->force);
  for (i = 0; i < NY; ++i) {
    row = room->J + i * wide;
    memset(row, 0, sizeof(V) * NX);
    memcpy(row + NX, room->force + i * asked->nq, sizeof(V) * asked->nq);
    /* The joint's angle is the servo's alone: most of what is asked for leaves it as it is. */
    there[i] = asked->extras > 0;
  }
  for (m = 0; m < SX + SD + SP; ++m)
    if (m < SX || m >= SX + SD || asked->moves) there[SEEN_ROW[m]] = 1;
  for (m = 0; m < SX; ++m) {
    const V *from = room->M + SEEN_COLUMN[m] * n, a = out[NY + m];
    row = room->J + SEEN_ROW[m] * wide;
    for (c = 0; c < n; ++c) row[c] += a * from[c];
  }
  for (i = 0; i < NY; ++i) {
    row = room->J + i * wide;
    for (l = 0; l < L; ++l) {
      const Run* run = group->of[l];
      for (c = 0; c < asked->extras; ++c)
        row[n + c][l] = run->more[(place[l] * NY + i) * asked->extras + c];
      row[wide - 1][l] = out[i][l] - run->data[place[l] * NY + i];
    }
    for (l = 0; l < L; ++l)
      if (!isfinite(row[wide - 1][l])) leave_out(row, wide, l);
    for (c = 0; c < wide; ++c) row[c] *= weight[i];
    if (!there[i]) S[wide * (wide + 1) / 2 - 1] += row[wide - 1] * row[wide - 1];
  }
  for (c = 0; c < wide; ++c) {
    V* sum = S + c * wide - c * (c - 1) / 2 - c;
    for (i = 0; i < NY; ++i) {
      const V a = room->J[i * wide + c];
      row = room->J + i * wide;
      if (there[i])
        for (b = c; b < wide; ++b) sum[b] += a * row[b];
    }
  }
}

int rr_grams(long long count, const Run* runs, long long each, long long nq, long long entries,
             long long moves, long long extras, const long long* first, const long long* column,
             const long long* move) {
  const Asked asked = {nq, entries, moves, extras, first, column, move};
  long long from, k, c, b;
  Room room;
  if (!room_for(&asked, &room)) return 0;
  FORGETS;
  for (from = 0; from < count; from += L) {
    Group group;
    V x[NX], end[NX], in[NODE];
    int l, i;
    group_of(runs, from, count, &group);
    memset(room.M, 0, sizeof(V) * NX * room.n);
    memset(room.S, 0, sizeof(V) * room.wide * (room.wide + 1) / 2);
    for (i = 0; i < NX; ++i) room.M[i * room.n + i] = all(1.0);
    for (l = 0; l < L; ++l) {
      for (i = 0; i < NX; ++i) x[i][l] = group.of[l]->states[i];
      for (c = 0; c < entries; ++c) room.value[c][l] = group.of[l]->value[c];
    }
    for (k = 0; k <= group.most; ++k) {
      if (k % each == 0) seen_at(&group, &asked, &room, k, each, x);
      if (k == group.most) break;
      step_inputs(&group, k, in);
      for (l = 0; l < L; ++l) {
        const Run* run = group.of[l];
        long long next = k < run->steps ? k + 1 : run->steps;
        for (i = 0; i < NX; ++i) end[i][l] = run->states[next * NX + i];
      }
      linear_step(&group, &asked, &room, k, each, in, x, end);
      for (i = 0; i < NX; ++i) x[i] = end[i];
    }
    for (l = 0; l < group.own; ++l) {
      double* gram = group.of[l]->gram;
      for (c = 0; c < room.wide; ++c)
        for (b = c; b < room.wide; ++b)
          gram[c * room.wide + b] = gram[b * room.wide + c] =
              room.S[c * room.wide - c * (c - 1) / 2 + b - c][l];
      for (c = 0; c < NX * room.n; ++c) group.of[l]->end[c] = room.M[c][l];
    }
  }
  free(room.all);
  REMEMBERS;
  return 1;
}
