"""Effects of a motion, each a plain function of it: what is not called costs nothing."""
