"""How results are written down: the model of a document, and its text, page and files."""
