"""The fastest gait: test problems, the best known answers, and what a user would write instead."""
