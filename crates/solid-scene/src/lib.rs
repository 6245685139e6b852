//! Animated scenes.
