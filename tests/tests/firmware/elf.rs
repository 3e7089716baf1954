//! The little of an ELF file of a 32-bit core that the tests read.

use std::path::Path;

/// Symbols and size of an image.
#[derive(Debug)]
pub struct Image {
    /// Names of all symbols.
    pub symbols: Vec<String>,
    /// Bytes that stand in flash: code, constants, and what starts with a value.
    pub flash: usize,
}

/// A section's header.
struct Section {
    kind: usize,
    flags: usize,
    offset: usize,
    size: usize,
    link: usize,
}

const SYMBOLS: usize = 2;
const NO_BITS: usize = 8;
const ALLOCATED: usize = 2;

impl Image {
    /// Reads a file in the little-endian format of 32 bits.
    pub fn read(path: &Path) -> Self {
        let file = std::fs::read(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
        assert_eq!(file[..6], *b"\x7fELF\x01\x01", "{}", path.display());
        let half = |at: usize| usize::from(u16::from_le_bytes([file[at], file[at + 1]]));
        let word = |at: usize| half(at) | half(at + 2) << 16;
        let (table, each, many) = (word(0x20), half(0x2e), half(0x30));
        let section = |index: usize| {
            let at = table + each * index;
            let field = |k: usize| word(at + 4 * k);
            Section { kind: field(1), flags: field(2), offset: field(4), size: field(5), link: field(6) }
        };
        let sections: Vec<Section> = (0..many).map(section).collect();
        let name = |at: usize| {
            let end = file[at..].iter().position(|&byte| byte == 0).expect("a name ends with 0");
            String::from_utf8_lossy(&file[at..at + end]).into_owned()
        };
        let mut symbols = Vec::new();
        for table in sections.iter().filter(|section| section.kind == SYMBOLS) {
            let names = sections[table.link].offset;
            symbols.extend((0..table.size / 16).map(|k| name(names + word(table.offset + 16 * k))));
        }
        let in_flash = |section: &&Section| section.flags & ALLOCATED != 0 && section.kind != NO_BITS;
        Self { symbols, flash: sections.iter().filter(in_flash).map(|section| section.size).sum() }
    }

    /// Symbols of what panics, allocates, formats or computes in double precision.
    pub fn foul(&self) -> Vec<&str> {
        let foul = |name: &&str| {
            let double =
                ["__aeabi_d", "__adddf", "__subdf", "__muldf", "__divdf", "__extendsfdf", "__truncdfsf"];
            ["panic", "unwind", "alloc", "3fmt"].iter().any(|part| name.contains(part))
                || double.iter().any(|start| name.starts_with(start))
        };
        self.symbols.iter().map(String::as_str).filter(foul).collect()
    }
}
