//! The other systems: each behind the trait of its kind, each judged by the oracle.
