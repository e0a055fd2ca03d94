"""What was found, with the evidence for it: checked, and ready to be shown."""
