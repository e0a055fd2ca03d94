"""Where the fault sits: tests of the way from the recording to the motion, stage by stage."""
