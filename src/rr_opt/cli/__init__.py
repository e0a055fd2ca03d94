"""The command line. A verb parses, calls and prints; it computes nothing."""
