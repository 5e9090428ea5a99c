"""Where does the model err? Unknown forces at every place, the force recovered, and a free-form law for it."""
