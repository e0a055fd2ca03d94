"""What a run leaves for people and scripts: JSON, text, figures and a page."""
