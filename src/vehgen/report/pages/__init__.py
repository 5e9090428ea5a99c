"""Which page tells of it? HTML pages: of a built vehicle and of a diagnosis."""
