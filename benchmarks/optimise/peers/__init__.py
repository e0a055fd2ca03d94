"""What a user would pick instead: each alternative in a file of its own, in its own idiom."""
