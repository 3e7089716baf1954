//! The bytes of an XML file as text: UTF-8, UTF-16 and Latin-1.

/// Why bytes are no text.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Unreadable {
    /// Line of the first byte that cannot be read, from 1; `None` where the whole file is meant.
    pub line: Option<usize>,
    /// What is wrong.
    pub problem: String,
    /// What to do about it.
    pub help: &'static str,
}

const SAVE: &str = "save the file as UTF-8";

/// Names under which a declaration may state Latin-1, in lower case.
const LATIN: [&str; 6] = ["iso-8859-1", "iso8859-1", "iso_8859-1", "latin-1", "latin1", "l1"];
/// The same for UTF-8, whose first half is ASCII. A declaration that can be read byte by byte is not UTF-16, whatever
/// it says: tools write `utf-16` there when they save a text from memory.
const UTF_8: [&str; 7] = ["utf-8", "utf8", "us-ascii", "ascii", "utf-16", "utf-16le", "utf-16be"];

/// The text of an XML file, without a byte order mark.
///
/// The order mark decides; without one the declaration does, and without that the file is UTF-8.
pub(super) fn text(bytes: &[u8]) -> Result<String, Unreadable> {
    match bytes {
        [0xef, 0xbb, 0xbf, rest @ ..] => return utf_8(rest),
        [0xff, 0xfe, rest @ ..] => return utf_16(rest, u16::from_le_bytes),
        [0xfe, 0xff, rest @ ..] => return utf_16(rest, u16::from_be_bytes),
        [b'<', 0, ..] => return utf_16(bytes, u16::from_le_bytes),
        [0, b'<', ..] => return utf_16(bytes, u16::from_be_bytes),
        _ => {}
    }
    let Some(name) = declared(bytes) else { return utf_8(bytes) };
    let lower = name.to_ascii_lowercase();
    if UTF_8.contains(&lower.as_str()) {
        utf_8(bytes)
    } else if LATIN.contains(&lower.as_str()) {
        Ok(bytes.iter().map(|&byte| char::from(byte)).collect())
    } else {
        let problem = format!("declares the encoding {name:?}, which is not supported");
        Err(Unreadable { line: Some(1), problem, help: SAVE })
    }
}

/// The encoding that the XML declaration names.
fn declared(bytes: &[u8]) -> Option<String> {
    let head = bytes.trim_ascii_start().strip_prefix(b"<?xml")?;
    let end = head.windows(2).position(|pair| pair == b"?>")?;
    let inside = String::from_utf8_lossy(head.get(..end)?);
    let value = inside.split_once("encoding")?.1.trim_start().strip_prefix('=')?.trim_start();
    let quote = value.chars().next().filter(|c| matches!(c, '"' | '\''))?;
    value.get(1..)?.split_once(quote).map(|(name, _)| name.to_string())
}

fn utf_8(bytes: &[u8]) -> Result<String, Unreadable> {
    std::str::from_utf8(bytes).map(str::to_string).map_err(|error| {
        let good = bytes.get(..error.valid_up_to()).unwrap_or_default();
        let byte = bytes.get(error.valid_up_to()).copied().unwrap_or_default();
        Unreadable {
            line: Some(line(&String::from_utf8_lossy(good))),
            problem: format!("holds the byte {byte:#04x}, which is not UTF-8"),
            help: "save the file as UTF-8, or declare encoding=\"ISO-8859-1\" where it is Latin-1",
        }
    })
}

fn utf_16(bytes: &[u8], word: fn([u8; 2]) -> u16) -> Result<String, Unreadable> {
    let wrong = |problem: &str| Unreadable { line: None, problem: problem.to_string(), help: SAVE };
    let (pairs, rest) = bytes.as_chunks::<2>();
    if !rest.is_empty() {
        return Err(wrong("is UTF-16 with half a character at its end"));
    }
    let words = pairs.iter().map(|&pair| word(pair));
    char::decode_utf16(words).collect::<Result<String, _>>().map_err(|_| wrong("is not valid UTF-16"))
}

/// Number of the line that begins or goes on behind `text`, from 1; `\n`, `\r\n` and `\r` end lines.
pub(super) fn line(text: &str) -> usize {
    let ends = text.matches(['\n', '\r']).count() - text.matches("\r\n").count();
    1 + ends
}

#[cfg(test)]
mod tests {
    use super::*;

    const NAME: &str = "<?xml version=\"1.0\" encoding=\"ENCODING\"?>\n<robot name=\"Ärmchen\"/>\n";

    #[test]
    fn declared_and_marked_encodings_give_the_same_text() {
        let utf_8 = NAME.replace("ENCODING", "utf-8");
        assert_eq!(text(utf_8.as_bytes()).as_deref(), Ok(utf_8.as_str()));
        let latin = NAME.replace("ENCODING", "ISO-8859-1");
        let bytes: Vec<u8> = latin.chars().map(|c| u8::try_from(u32::from(c)).expect("Latin-1")).collect();
        assert_eq!(text(&bytes), Ok(latin));
        let wide = NAME.replace("ENCODING", "UTF-16");
        for (to_bytes, mark) in
            [(u16::to_le_bytes as fn(u16) -> [u8; 2], [0xff, 0xfe]), (u16::to_be_bytes, [0xfe, 0xff])]
        {
            let plain: Vec<u8> = wide.encode_utf16().flat_map(to_bytes).collect();
            assert_eq!(text(&plain).as_ref(), Ok(&wide));
            assert_eq!(text(&[mark.as_slice(), &plain].concat()).as_ref(), Ok(&wide));
            assert!(text(&plain[..plain.len() - 1]).is_err());
        }
    }

    #[test]
    fn what_cannot_be_read_is_named_with_its_line() {
        let broken = text(b"<robot>\r\n<a/>\r\n<b n=\"\xe4\"/>").expect_err("not UTF-8");
        assert_eq!((broken.line, broken.problem.contains("0xe4")), (Some(3), true));
        let other = text(b"<?xml version='1.0' encoding='Shift_JIS'?><robot/>").expect_err("not read");
        assert!(other.problem.contains("\"Shift_JIS\""), "{other:?}");
        assert_eq!(line("a\rb\r\nc\nd"), 4);
    }
}
