"""Which page tells of it? HTML pages: of a built vehicle, of an assessed run and of a diagnosis."""
