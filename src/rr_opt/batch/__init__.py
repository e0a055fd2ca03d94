"""Running many cases: on this machine's processes or a cluster's, and keeping what is finished."""

ONE_THREAD = {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1", "MKL_NUM_THREADS": "1"}
"""As environment variables, to be set before NumPy is loaded: one case takes one core."""
