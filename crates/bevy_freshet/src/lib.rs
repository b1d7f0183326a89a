//! Real-time water for the Bevy engine.
