"""Freedoms of a linkage on the host: mobility, infeasible drives, idle motions, rounded and open loops."""
