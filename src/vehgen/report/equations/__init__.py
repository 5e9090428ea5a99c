"""What are its equations? The equations of motion for reading: text, LaTeX and MathML."""
