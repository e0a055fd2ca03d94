/* Predict runs, and linearise them, L of them side by side.

   Around functions of a system that were written above:
     step_1(x, kept, out)     a step's end; x is the state and behind it the step's inputs: its
                              length and the drive at its beginning, middle and end
     tangent_1(x, kept, out)  a step linearised: P and Q, of dx' = P dx + Q (R du + S dp), then R
                              and S; x is the state and the drive in the middle of the step, and its
                              length
     seen_1(x, kept, out)     what is seen, and its derivatives by state, drive and p; x is the state
                              and behind it the drive
   each after NAME_0(p, kept), which is what they need of p alone. Of matrices there are the
   nonzeros, column by column. TANGENT_ROW, TANGENT_COLUMN, SEEN_ROW, SEEN_COLUMN say where those by
   drive and p stand; p_times, q_times and seen_times (by the state) add the product with a vector.
*/

#define NODE (1 + 3 * ND)

#define UNROLLED _Pragma("GCC unroll 8")

/* Steps whose inputs are read at once: numbers written one by one are slow to read as a vector. */
#define BLOCK 16

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
   moved_at (samples, ND, moves), moved (steps, ND, moves)   of d(drive)/dq, its columns that are not
                           zero; the second in the middle of the steps
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
  V step_kept[K_STEP + 1], tangent_kept[K_TANGENT + 1], seen_kept[K_SEEN + 1];
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
  tangent_0(p, group->tangent_kept);
  seen_0(p, group->seen_kept);
}

/* The length and drive of BLOCK steps from k on; of a run that has ended, steps of no length. */
static void block_inputs(const Group* group, long long k, V* in) {
  long long s;
  int l, i;
  for (l = 0; l < L; ++l) {
    const Run* run = group->of[l];
    for (s = 0; s < BLOCK; ++s) {
      const double* from = run->inputs + (k + s < run->steps ? k + s : run->steps - 1) * NODE;
      for (i = 0; i < NODE; ++i) in[s * NODE + i][l] = from[i];
      if (k + s >= run->steps) in[s * NODE][l] = 0.0;
    }
  }
}

/* The states before BLOCK steps from k on, and behind them; of a run that has ended, its last. */
static void block_states(const Group* group, long long k, V* x) {
  long long s;
  int l, i;
  for (l = 0; l < L; ++l) {
    const Run* run = group->of[l];
    for (s = 0; s <= BLOCK; ++s)
      for (i = 0; i < NX; ++i)
        x[s * NX + i][l] = run->states[(k + s < run->steps ? k + s : run->steps) * NX + i];
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
  long long from, k, s, sample;
  FORGETS;
  for (from = 0; from < count; from += L) {
    Group group;
    V in[BLOCK * NODE], made[BLOCK * NX], x[NX + NODE], at[NX + ND], out[NX + NY + SEEN];
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
      s = k % BLOCK;
      if (s == 0) block_inputs(&group, k, in);
      for (i = 0; i < NODE; ++i) x[NX + i] = in[s * NODE + i];
      step_1(x, group.step_kept, out);
      for (i = 0; i < NX; ++i) made[s * NX + i] = x[i] = out[i];
      if (s < BLOCK - 1 && k < group.most - 1) continue;
      for (l = 0; l < group.own; ++l) {
        double* states = group.of[l]->states + (k - s + 1) * NX;
        long long c, most = (group.of[l]->steps - k + s) * NX;
        for (c = 0; c < (s + 1) * NX && c < most; ++c) states[c] = made[c][l];
      }
    }
  }
  REMEMBERS;
}

/* Derivatives by q are sums of products: target += by * from, with `by` a nonzero of R or S and
   `from` an entry of dp/dq or of d(drive)/dq. `last`: of its target. */
typedef struct {
  int target, by, from, last;
} Term;

static int by_target(const void* one, const void* other) {
  const Term *a = one, *b = other;
  return a->target != b->target ? a->target - b->target : a->by - b->by;
}

/* The terms of R, of which there are nr nonzeros, and of S, ns; returns how many. */
static long long terms_of(const int* row, const int* column, int nr, int ns, const Asked* asked,
                          Term* terms) {
  long long count = 0, e, c;
  int k;
  for (k = 0; k < nr; ++k)
    for (c = 0; c < asked->moves; ++c)
      terms[count++] = (Term){row[k] * asked->nq + asked->move[c], k,
                              asked->entries + column[k] * asked->moves + c, 0};
  for (k = nr; k < nr + ns; ++k)
    for (e = asked->first[column[k]]; e < asked->first[column[k] + 1]; ++e)
      terms[count++] = (Term){row[k] * asked->nq + asked->column[e], k, e, 0};
  qsort(terms, count, sizeof(Term), by_target);
  for (k = 0; k < count; ++k)
    terms[k].last = k == count - 1 || terms[k].target != terms[k + 1].target;
  return count;
}

/* Targets without a term stay as they are. */
INLINE void add_terms(const Term* terms, long long count, const V* by, const V* from, V* target) {
  long long k;
  for (k = 0; k < count; ++k) {
    V sum = by[terms[k].by] * from[terms[k].from];
    for (; !terms[k].last; ++k) sum += by[terms[k + 1].by] * from[terms[k + 1].from];
    target[terms[k].target] = sum;
  }
}

/* Room for a group: M (NX, n) the derivatives of the state, n = NX + nq; those of a step and of what
   is seen by q; the rows of J at a sample (NY, wide); J'J, its upper triangle row by row; and what
   the terms are taken from, with their tables. */
typedef struct {
  V *M, *of_step, *of_seen, *J, *S, *from;
  Term *by_step, *by_seen;
  long long n, wide, step_terms, seen_terms;
  void* all;
} Room;

static int room_for(const Asked* asked, Room* room) {
  long long n = NX + asked->nq, wide = n + asked->extras + 1;
  long long sizes[6] = {NX * n,    NX * asked->nq,          NY * asked->nq,
                        NY * wide, wide * (wide + 1) / 2, asked->entries + ND * asked->moves};
  V** places[6] = {&room->M, &room->of_step, &room->of_seen, &room->J, &room->S, &room->from};
  long long most_step = TANGENT_R * asked->moves + TANGENT_S * asked->nq;
  long long most_seen = SEEN_R * asked->moves + SEEN_S * asked->nq, terms, total = 0, k;
  for (k = 0; k < 6; ++k) total += sizes[k] * sizeof(V);
  terms = ((most_step + most_seen) * sizeof(Term) / sizeof(V) + 1) * sizeof(V);
  room->all = aligned_alloc(sizeof(V), total + terms);
  if (!room->all) return 0;
  memset(room->all, 0, total);
  for (k = total = 0; k < 6; total += sizes[k++]) *places[k] = (V*)room->all + total;
  room->by_step = (Term*)((V*)room->all + total);
  room->by_seen = room->by_step + most_step;
  room->n = n;
  room->wide = wide;
  room->step_terms =
      terms_of(TANGENT_ROW, TANGENT_COLUMN, TANGENT_R, TANGENT_S, asked, room->by_step);
  room->seen_terms = terms_of(SEEN_ROW, SEEN_COLUMN, SEEN_R, SEEN_S, asked, room->by_seen);
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

/* M after step k, from the middle of its chord. */
static void linear_step(const Group* group, const Asked* asked, const Room* room, long long k,
                        const V* in, const V* x) {
  V at[NX + ND + 1], out[TANGENT], m[NX], f[NX], to[NX];
  const V *P = out, *Q = P + TANGENT_P, *by = Q + TANGENT_Q;
  long long place[L], n = room->n, c;
  int i, l;
  for (i = 0; i < NX; ++i) at[i] = (x[i] + x[NX + i]) / 2.0;
  for (i = 0; i < ND; ++i) at[NX + i] = in[1 + ND + i];
  at[NX + ND] = in[0];
  tangent_1(at, group->tangent_kept, out);
  if (asked->moves) {
    for (l = 0; l < L; ++l) {
      long long last = group->of[l]->steps - 1;
      place[l] = k < last ? k : last;
    }
    moved_at(group, asked, 1, place, room->from + asked->entries);
  }
  add_terms(room->by_step, room->step_terms, by, room->from, room->of_step);
  for (c = 0; c < n; ++c) {
    UNROLLED for (i = 0; i < NX; ++i) m[i] = room->M[i * n + c], to[i] = all(0.0);
    p_times(P, m, to);
    if (c >= NX) {
      UNROLLED for (i = 0; i < NX; ++i) f[i] = room->of_step[i * asked->nq + c - NX];
      q_times(Q, f, to);
    }
    UNROLLED for (i = 0; i < NX; ++i) room->M[i * n + c] = to[i];
  }
}

/* Which rows of J are not 0: the joint's angle is the servo's alone, and most of what is asked for
   leaves it as it is. Returns how many. */
static int rows_there(const Asked* asked, int* there) {
  int i, m, own[NY], count = 0;
  for (i = 0; i < NY; ++i) own[i] = BY_STATE[i] || asked->extras > 0;
  for (m = 0; m < SEEN_R + SEEN_S; ++m)
    if (m >= SEEN_R || asked->moves) own[SEEN_ROW[m]] = 1;
  for (i = 0; i < NY; ++i) there[i] = own[i] ? count++ : -1;
  return count;
}

/* J'J of some rows. */
INLINE void add_rows(const V* J, long long wide, V* S, int rows) {
  long long c, b;
  int i;
  for (c = 0; c < wide; S += wide - c, ++c) {
    V own[4];
    UNROLLED for (i = 0; i < rows; ++i) own[i] = J[i * wide + c];
    for (b = c; b < wide; ++b) {
      V sum = S[b - c];
      UNROLLED for (i = 0; i < rows; ++i) sum += own[i] * J[i * wide + b];
      S[b - c] = sum;
    }
  }
}

/* What a sample adds to J'J. */
static void seen_at(const Group* group, const Asked* asked, const Room* room, const int* there,
                    int rows, long long k, long long each, const V* x) {
  V at[NX + ND], out[NY + SEEN], off[NY], weight[NY], m[NX], to[NY];
  const V* by = out + NY;
  long long place[L], n = room->n, wide = room->wide, c;
  int i, l;
  for (i = 0; i < NX; ++i) at[i] = x[i];
  drive_at(group, k, each, at + NX);
  seen_1(at, group->seen_kept, out);
  for (l = 0; l < L; ++l) {
    int seen = at_sample(group, l, k, each, place + l);
    for (i = 0; i < NY; ++i) {
      weight[i][l] = seen ? group->of[l]->weight[place[l] * NY + i] : 0.0;
      off[i][l] = group->of[l]->data[place[l] * NY + i];
    }
  }
  if (asked->moves) moved_at(group, asked, 0, place, room->from + asked->entries);
  add_terms(room->by_seen, room->seen_terms, by + SEEN_X, room->from, room->of_seen);
  for (i = 0; i < NY; ++i) off[i] = (out[i] - off[i]) * weight[i];
  for (c = 0; c < n; ++c) {
    UNROLLED for (i = 0; i < NX; ++i) m[i] = room->M[i * n + c];
    UNROLLED for (i = 0; i < NY; ++i)
      to[i] = c < NX ? all(0.0) : room->of_seen[i * asked->nq + c - NX];
    seen_times(by, m, to);
    for (i = 0; i < NY; ++i)
      if (there[i] >= 0) room->J[there[i] * wide + c] = to[i] * weight[i];
  }
  for (i = 0; i < NY; ++i) {
    V* row = room->J + there[i] * wide;
    for (l = 0; there[i] >= 0 && l < L; ++l)
      for (c = 0; c < asked->extras; ++c)
        row[n + c][l] =
            group->of[l]->more[(place[l] * NY + i) * asked->extras + c] * weight[i][l];
    /* A prediction that has left the numbers says nothing at this sample, nor in a gap. */
    for (l = 0; l < L; ++l)
      if (!isfinite(off[i][l])) {
        off[i][l] = 0.0;
        for (c = 0; there[i] >= 0 && c < wide; ++c) row[c][l] = 0.0;
      }
    if (there[i] >= 0)
      row[wide - 1] = off[i];
    else
      room->S[wide * (wide + 1) / 2 - 1] += off[i] * off[i];
  }
  for (i = 0; i + 4 <= rows; i += 4) add_rows(room->J + i * wide, wide, room->S, 4);
  if (rows - i == 3) add_rows(room->J + i * wide, wide, room->S, 3);
  if (rows - i == 2) add_rows(room->J + i * wide, wide, room->S, 2);
  if (rows - i == 1) add_rows(room->J + i * wide, wide, room->S, 1);
}

int rr_grams(long long count, const Run* runs, long long each, long long nq, long long entries,
             long long moves, long long extras, const long long* first, const long long* column,
             const long long* move) {
  const Asked asked = {nq, entries, moves, extras, first, column, move};
  long long from, k, c, b;
  int there[NY], rows = rows_there(&asked, there);
  Room room;
  if (!room_for(&asked, &room)) return 0;
  FORGETS;
  for (from = 0; from < count; from += L) {
    Group group;
    V x[(BLOCK + 1) * NX], in[BLOCK * NODE];
    int l, i;
    group_of(runs, from, count, &group);
    memset(room.M, 0, sizeof(V) * NX * room.n);
    memset(room.S, 0, sizeof(V) * room.wide * (room.wide + 1) / 2);
    for (i = 0; i < NX; ++i) room.M[i * room.n + i] = all(1.0);
    for (l = 0; l < L; ++l)
      for (c = 0; c < entries; ++c) room.from[c][l] = group.of[l]->value[c];
    for (k = 0; k <= group.most; ++k) {
      long long s = k % BLOCK;
      if (s == 0) block_inputs(&group, k, in), block_states(&group, k, x);
      if (k % each == 0) seen_at(&group, &asked, &room, there, rows, k, each, x + s * NX);
      if (k < group.most) linear_step(&group, &asked, &room, k, in + s * NODE, x + s * NX);
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
