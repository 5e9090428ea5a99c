"""Files: read safely, written whole."""
