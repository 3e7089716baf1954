//! XML as a tree of elements, each with its line in the file.
//!
//! Names are taken as they are written: robot files hold prefixes that nobody declares. Depth is bounded while reading,
//! so that no later walk over the tree can run out of stack.

use std::path::Path;

use quick_xml::events::{BytesStart, Event};
use quick_xml::{Reader, escape};

use super::super::place::Place;
use super::encoding;
use crate::error::Diagnostics;

/// Most elements around one another; robot files have about ten.
const MOST_DEPTH: usize = 100;
/// Most elements of a file; a robot of 100 links has about 3000.
const MOST_ELEMENTS: usize = 1_000_000;
/// Most attributes of one element; robot files have up to ten.
const MOST_ATTRIBUTES: usize = 1000;

/// One element.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) struct Element {
    /// Its name, prefix included.
    pub name: String,
    /// Line of its opening tag, from 1.
    pub line: usize,
    /// Its attributes, in order.
    pub attributes: Vec<Attribute>,
    /// Text directly inside it.
    pub text: String,
    /// The elements directly inside it.
    pub children: Vec<Element>,
}

/// One attribute.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Attribute {
    /// Its name, prefix included.
    pub name: String,
    /// Its value, with the five entities of XML and those of characters replaced.
    pub value: String,
    /// Its line, from 1.
    pub line: usize,
}

impl Element {
    /// The attribute `name`.
    pub fn attribute(&self, name: &str) -> Option<&Attribute> {
        self.attributes.iter().find(|attribute| attribute.name == name)
    }

    /// The elements `name` directly inside this one.
    pub fn all<'a>(&'a self, name: &'a str) -> impl Iterator<Item = &'a Self> {
        self.children.iter().filter(move |child| child.name == name)
    }

    /// The element `name` directly inside this one, after a fault where there are several; `place` is this element's.
    pub fn one(&self, name: &str, place: &Place, faults: &mut Diagnostics) -> Option<&Self> {
        let first = self.children.iter().find(|child| child.name == name)?;
        for other in self.all(name).skip(1) {
            let problem = format!("occurs twice, first in line {}", first.line);
            place.at(name).on(other.line).fault(faults, problem, format!("keep one <{name}>"));
        }
        Some(first)
    }
}

/// The root element of `text`; `None` after a fault.
pub(super) fn read(text: &str, file: &Path, faults: &mut Diagnostics) -> Option<Element> {
    match Parser::new(text).root() {
        Ok(root) => Some(root),
        Err(wrong) => {
            let place = Place::new(file, "");
            let place = wrong.line.map_or(place.clone(), |line| place.on(line));
            place.fault(faults, wrong.problem, wrong.help);
            None
        }
    }
}

/// Why a text is no tree of elements.
struct Wrong {
    line: Option<usize>,
    problem: String,
    help: &'static str,
}

struct Parser<'a> {
    text: &'a str,
    /// Bytes whose lines are counted, and the line that they end in.
    counted: (usize, usize),
    open: Vec<Element>,
    root: Option<Element>,
    elements: usize,
}

impl<'a> Parser<'a> {
    fn new(text: &'a str) -> Self {
        Self { text, counted: (0, 1), open: Vec::new(), root: None, elements: 0 }
    }

    fn root(mut self) -> Result<Element, Wrong> {
        let mut reader = Reader::from_str(self.text);
        loop {
            let at = offset(reader.buffer_position());
            let event = reader.read_event().map_err(|error| {
                let at = offset(reader.error_position()).max(at);
                self.malformed(at, &error.to_string())
            })?;
            match event {
                Event::Start(tag) => {
                    let element = self.element(&tag, at)?;
                    self.open.push(element);
                    if self.open.len() > MOST_DEPTH {
                        return Err(Wrong {
                            line: Some(self.line(at)),
                            problem: format!("nests more than {MOST_DEPTH} elements"),
                            help: "give a URDF file; robots are described in about ten levels",
                        });
                    }
                }
                Event::Empty(tag) => {
                    let element = self.element(&tag, at)?;
                    self.close(element, at)?;
                }
                Event::End(_) => {
                    if let Some(element) = self.open.pop() {
                        self.close(element, at)?;
                    }
                }
                Event::Text(text) => self.characters(&String::from_utf8_lossy(&text), at)?,
                Event::CData(text) => self.characters(&String::from_utf8_lossy(&text), at)?,
                Event::Eof => break,
                Event::GeneralRef(_)
                | Event::Comment(_)
                | Event::Decl(_)
                | Event::PI(_)
                | Event::DocType(_) => {}
            }
        }
        if let Some(element) = self.open.last() {
            let (line, name) = (element.line, element.name.clone());
            let problem = format!("is not a URDF file that can be read (<{name}> is not closed)");
            return Err(Wrong { line: Some(line), problem, help: "close the element" });
        }
        self.root.ok_or(Wrong {
            line: None,
            problem: "has no XML element".into(),
            help: "give a URDF file, whose root is <robot>",
        })
    }

    fn element(&mut self, tag: &BytesStart<'_>, at: usize) -> Result<Element, Wrong> {
        self.elements += 1;
        let line = self.line(at);
        if self.elements > MOST_ELEMENTS {
            let problem = format!("has more than {MOST_ELEMENTS} elements");
            return Err(Wrong { line: Some(line), problem, help: "give the URDF file of one arm" });
        }
        let mut attributes = Vec::new();
        for attribute in tag.attributes() {
            if attributes.len() == MOST_ATTRIBUTES {
                let problem = format!("has an element with more than {MOST_ATTRIBUTES} attributes");
                return Err(Wrong { line: Some(line), problem, help: "give the URDF file of one arm" });
            }
            let attribute = attribute.map_err(|error| self.malformed(at, &error.to_string()))?;
            let raw = String::from_utf8_lossy(&attribute.value).into_owned();
            // An entity that the file itself declares stays as it is written: only a name or number that is used matters.
            // A character by its number is there or is none.
            let value = match escape::unescape(&raw) {
                Ok(value) => value.into_owned(),
                Err(error) if raw.contains("&#") => return Err(self.malformed(at, &error.to_string())),
                Err(_) => raw.clone(),
            };
            let key = attribute.key.into_inner();
            let line = self.line(self.position(key).unwrap_or(at));
            attributes.push(Attribute { name: String::from_utf8_lossy(key).into_owned(), value, line });
        }
        let name = String::from_utf8_lossy(tag.name().into_inner()).into_owned();
        Ok(Element { name, line, attributes, text: String::new(), children: Vec::new() })
    }

    fn close(&mut self, element: Element, at: usize) -> Result<(), Wrong> {
        match self.open.last_mut() {
            Some(parent) => parent.children.push(element),
            None if self.root.is_none() => self.root = Some(element),
            None => return Err(self.malformed(at, "there is a second root element")),
        }
        Ok(())
    }

    fn characters(&mut self, text: &str, at: usize) -> Result<(), Wrong> {
        let trimmed = text.trim();
        if let Some(element) = self.open.last_mut() {
            element.text.push_str(trimmed);
        } else if let Some(root) = self.root.as_ref().filter(|_| !trimmed.is_empty()) {
            let problem = format!("has text behind </{}>", root.name);
            let at = at + text.len() - text.trim_start().len();
            return Err(Wrong {
                line: Some(self.line(at)),
                problem,
                help: "remove it: the file ends with that tag",
            });
        }
        Ok(())
    }

    /// Where a part of the text begins in it.
    fn position(&self, part: &[u8]) -> Option<usize> {
        let at = (part.as_ptr() as usize).checked_sub(self.text.as_ptr() as usize)?;
        (at < self.text.len()).then_some(at)
    }

    /// The line of byte `at`.
    fn line(&mut self, at: usize) -> usize {
        let (from, line) = if self.counted.0 <= at { self.counted } else { (0, 1) };
        let passed = self.text.as_bytes().get(from..at).unwrap_or_default();
        self.counted = (at, line + encoding::line(&String::from_utf8_lossy(passed)) - 1);
        self.counted.1
    }

    fn malformed(&mut self, at: usize, what: &str) -> Wrong {
        Wrong {
            line: Some(self.line(at)),
            problem: format!("is not a URDF file that can be read ({what})"),
            help: "correct the XML there",
        }
    }
}

fn offset(position: u64) -> usize {
    usize::try_from(position).unwrap_or(usize::MAX)
}
