"""The machines that can be diagnosed, a folder each."""
