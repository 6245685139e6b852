//! The library beside the thesis's design and parry: the same inputs, one process, one run.
