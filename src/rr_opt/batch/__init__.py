"""Running many cases: on this machine's processes or a cluster's, and keeping what is finished."""
