"""How results are written: the model of a document, and its text, page and files."""
