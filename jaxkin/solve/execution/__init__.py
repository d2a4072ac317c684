"""How the solver runs: compiled programs, shards on several cores, batches of designs, loops in lockstep."""
