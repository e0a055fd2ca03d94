"""`python -m rr_opt`, the same as `rr-opt`."""

from rr_opt.cli.entry import main

if __name__ == "__main__":
    main()
