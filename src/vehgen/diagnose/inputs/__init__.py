"""Are the recordings what they are said to be? Checks of labels, signs, places and vehicle."""
