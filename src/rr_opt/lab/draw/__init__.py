"""Cases drawn by lot."""
