"""Could the recordings tell what was hidden? Asked of scored cases by one who knows the truth."""
