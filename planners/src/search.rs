//! Searches over the whole map: grid A* and random trees, the baselines of the receding horizon.
