//! The world.

slotmap::new_key_type! {
    /// An object of a world. The id of a removed object never comes back.
    pub struct ObjectId;
}
