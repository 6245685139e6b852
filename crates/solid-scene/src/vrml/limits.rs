//! How much a file may ask for. Every limit turns a hostile file into an error instead of a hang or an exhausted memory.

/// How deep brackets may nest in the text. The parser recurses once or twice for each; real exporters stay under 100.
pub(super) const NESTING_MAX: usize = 256;

/// Bytes in a file.
pub(super) const FILE_BYTES_MAX: u64 = 1 << 29;

/// Nodes written in a file and all those that it inlines, each counted once. The parser spends up to 10 kB on a node of many fields,
/// so that this is up to 2 GB.
pub(super) const WRITTEN_NODES_MAX: usize = 200_000;

/// ROUTEs written in one file: the parser compares each with all before it.
pub(super) const FILE_ROUTES_MAX: usize = 20_000;

/// Names that DEF gives again in one file, and those that PROTO and EXTERNPROTO do: the parser looks through all names for each.
pub(super) const FILE_REPEATS_MAX: usize = 20_000;

/// Fields and events declared in the PROTOs and Scripts of one file: the parser compares each with all before it in the
/// same PROTO or Script.
pub(super) const FILE_DECLARATIONS_MAX: usize = 20_000;

/// Fields and events declared in one PROTO or Script: for each field of an instance that is given a value, or asked for by an IS, all are
/// looked through. Of 20,000 a file of half a megabyte took 80 seconds.
pub(super) const DECLARATIONS_MAX: usize = 2_000;

/// Bytes of PROTO interface that the parser copies: once for each instance, and once for each IS. In its memory they are
/// up to 15 times as many.
pub(super) const COPIED_BYTES_MAX: usize = 1 << 26;

/// Nodes of a file times the names that DEF gives to nodes of other types than those of the standard, and USE has: where the parser
/// knows no such type it looks through all nodes for each. It takes some 8 seconds for so many.
pub(super) const OTHERS_USED_MAX: usize = 100_000_000;

/// Nodes after the instances of PROTO, Inline and USE are written out.
pub(super) const NODES_MAX: usize = 1_000_000;

/// URLs after the instances of PROTO and Inline are written out: each is copied and looked up, and an instance may have many. A long one counts
/// once for every [`URL_BYTES`] that it begins.
pub(super) const URLS_MAX: usize = 4_000_000;

/// Bytes that a URL may have and still count once.
pub(super) const URL_BYTES: usize = 64;

/// How deep nodes may nest when the instances are written out.
pub(super) const DEPTH_MAX: usize = 512;

/// How deep files may inline files.
pub(super) const INLINE_DEPTH_MAX: usize = 32;

/// Vertices, primitives, interpolated values and entries of paths in all of a scene: each is some 10 to 100 bytes.
pub(super) const ELEMENTS_MAX: usize = 16_000_000;

/// How many ROUTEs an event may follow from its sensor.
pub(super) const CHAIN_MAX: usize = 512;

/// The stack on which a file is read: enough for [`NESTING_MAX`] and [`DEPTH_MAX`], whatever the caller's stack is.
pub(super) const STACK_BYTES: usize = 64 << 20;
