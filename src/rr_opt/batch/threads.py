"""One thread for linear algebra: matrices are small here, and more would only spin."""

ONE_THREAD = {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1", "MKL_NUM_THREADS": "1"}
"""As environment variables, to be set before NumPy is loaded."""
