/* x <- step(x, inputs, p) over the steps of several runs, one in each lane.

   step_1(x, kept, out) was written above: x is the state and behind it the step's inputs; after
   step_0(p, kept), which is what it needs of p alone. */

/* first (NX), inputs (steps, NI), p (NP); states (steps, NX) after each step. */
typedef struct {
  long long steps;
  const double *first, *inputs, *p;
  double *states;
} Run;

void rr_recur(long long count, const Run* runs) {
  long long from, k;
  int l, i;
  for (from = 0; from < count; from += L) {
    const Run* of[L];
    const long long own = count - from < L ? count - from : L;
    long long most = 0;
    V x[NX + NI], p[NP + 1], kept[KEPT + 1], out[NX];
    for (l = 0; l < L; ++l) {
      of[l] = runs + (l < own ? from + l : count - 1);
      if (of[l]->steps > most) most = of[l]->steps;
      for (i = 0; i < NX; ++i) x[i][l] = of[l]->first[i];
      for (i = 0; i < NP; ++i) p[i][l] = of[l]->p[i];
    }
    step_0(p, kept);
    for (k = 0; k < most; ++k) {
      for (l = 0; l < L; ++l) {
        const long long last = of[l]->steps - 1;
        for (i = 0; i < NI; ++i) x[NX + i][l] = of[l]->inputs[(k < last ? k : last) * NI + i];
      }
      step_1(x, kept, out);
      for (i = 0; i < NX; ++i) x[i] = out[i];
      for (l = 0; l < own; ++l)
        if (k < of[l]->steps)
          for (i = 0; i < NX; ++i) of[l]->states[k * NX + i] = out[i][l];
    }
  }
}
