"""Run the solver: compiled programs, shards of long ranges on several cores, batches of designs."""
