"""What was found, with the evidence for it, as data that can print, draw and save itself."""
