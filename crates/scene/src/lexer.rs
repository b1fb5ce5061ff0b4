//! Splits the bytes of a scene into words.
//!
//! The first stage of reading: `bytes ──lex──▶ tokens`. Lexing cannot fail and knows no keywords. Tokens are made on
//! demand and hold only their place, so a mesh of millions of numbers costs no memory here. A [`Lexer`] is a cursor
//! that can be copied, which is how the parser looks ahead.
//!
//! The rules are Sunflow's (format reference, §1.1): words are separated by white space, a quote switches between
//! plain and quoted text and ends the word before it, `#` and `%` at the start of a word hide the rest of the line,
//! and everything between the words `/*` and `*/` is hidden too. A quotation ends with its line.

/// A word: the bytes from `start` to `end`, never empty, without quotes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Token {
    /// First byte.
    pub start: u32,
    /// One past the last byte.
    pub end: u32,
}

impl Token {
    /// The bytes of the word.
    pub fn bytes(self, bytes: &[u8]) -> &[u8] {
        &bytes[self.start as usize..self.end as usize]
    }
}

/// What a byte does outside of a word.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Class {
    Text,
    Space,
    Newline,
    Quote,
    Comment,
}

/// Whose text is split.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Syntax {
    /// A scene file.
    Scene,
    /// The value of an assignment on the command line: commas separate too, and `#` begins a colour.
    Assignment,
}

const SCENE: [Class; 256] = classes(Syntax::Scene);
const ASSIGNMENT: [Class; 256] = classes(Syntax::Assignment);

const fn classes(syntax: Syntax) -> [Class; 256] {
    let mut table = [Class::Text; 256];
    // Sunflow: Character.isWhitespace, as far as it is ASCII.
    let spaces = [b'\t', 0x0b, 0x0c, 0x1c, 0x1d, 0x1e, 0x1f, b' '];
    let mut i = 0;
    while i < spaces.len() {
        table[spaces[i] as usize] = Class::Space;
        i += 1;
    }
    table[b'\n' as usize] = Class::Newline;
    table[b'\r' as usize] = Class::Newline;
    table[b'"' as usize] = Class::Quote;
    match syntax {
        Syntax::Scene => {
            table[b'#' as usize] = Class::Comment;
            table[b'%' as usize] = Class::Comment;
        }
        Syntax::Assignment => table[b',' as usize] = Class::Space,
    }
    table
}

/// A cursor in the bytes of one file.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Lexer {
    position: usize,
    quoted: bool,
    classes: &'static [Class; 256],
    /// The last quote that was opened.
    quote: u32,
    /// The first quote that its line does not close.
    pub unclosed_quote: Option<u32>,
    /// Start of a block comment that the file never closes.
    pub unclosed_comment: Option<u32>,
}

impl Lexer {
    /// At the start of `bytes`, past a byte order mark.
    pub fn new(bytes: &[u8], syntax: Syntax) -> Self {
        let position = if bytes.starts_with(b"\xef\xbb\xbf") { 3 } else { 0 };
        Self::at(position, syntax)
    }

    /// At a byte offset that is not inside a quotation.
    pub fn at(position: usize, syntax: Syntax) -> Self {
        let classes = match syntax {
            Syntax::Scene => &SCENE,
            Syntax::Assignment => &ASSIGNMENT,
        };
        Lexer { position, quoted: false, classes, quote: 0, unclosed_quote: None, unclosed_comment: None }
    }

    /// One past the last byte that was read.
    pub fn position(&self) -> usize {
        self.position
    }

    /// How many bytes are left.
    pub fn remaining(&self, bytes: &[u8]) -> usize {
        bytes.len().saturating_sub(self.position)
    }

    /// The next word outside of block comments.
    #[inline]
    pub fn next(&mut self, bytes: &[u8]) -> Option<Token> {
        loop {
            let token = self.word(bytes)?;
            if token.end - token.start == 2 && token.bytes(bytes) == b"/*" {
                self.skip_comment(bytes, token)?;
            } else {
                return Some(token);
            }
        }
    }

    #[inline]
    fn word(&mut self, bytes: &[u8]) -> Option<Token> {
        loop {
            match self.classes[usize::from(*bytes.get(self.position)?)] {
                Class::Text => break,
                Class::Space if self.quoted => break,
                Class::Space => self.position += 1,
                Class::Newline => {
                    if self.quoted {
                        self.unclosed_quote.get_or_insert(self.quote);
                        self.quoted = false;
                    }
                    self.position += 1;
                }
                Class::Quote => {
                    self.quote = self.position as u32;
                    self.quoted = !self.quoted;
                    self.position += 1;
                }
                Class::Comment => self.skip_line(bytes),
            }
        }
        let start = self.position;
        let rest = &bytes[start..];
        let length = if self.quoted {
            rest.iter().position(|&b| matches!(self.classes[usize::from(b)], Class::Quote | Class::Newline))
        } else {
            let ends = |b: &u8| matches!(self.classes[usize::from(*b)], Class::Space | Class::Newline | Class::Quote);
            rest.iter().position(ends)
        };
        self.position = start + length.unwrap_or(rest.len());
        Some(Token { start: start as u32, end: self.position as u32 })
    }

    /// To the end of the line, which stays.
    fn skip_line(&mut self, bytes: &[u8]) {
        let rest = &bytes[self.position..];
        self.position += rest.iter().position(|&b| b == b'\n' || b == b'\r').unwrap_or(rest.len());
    }

    /// Past the word `*/`. Line comments are still seen inside and may hide it.
    fn skip_comment(&mut self, bytes: &[u8], opening: Token) -> Option<()> {
        while let Some(token) = self.word(bytes) {
            if token.bytes(bytes) == b"*/" {
                return Some(());
            }
        }
        self.unclosed_comment = Some(opening.start);
        None
    }

    /// Past the line `</code>`, standing right after the word `<code>`: the lines between are not words.
    pub fn skip_code(&mut self, bytes: &[u8]) {
        self.quoted = false;
        self.skip_line(bytes);
        while self.position < bytes.len() {
            self.position += 1;
            let start = self.position.min(bytes.len());
            self.skip_line(bytes);
            if bytes[start..self.position].trim_ascii() == b"</code>" {
                return;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn words_of(syntax: Syntax, text: &[u8]) -> Vec<String> {
        let mut lexer = Lexer::new(text, syntax);
        let next = || lexer.next(text).map(|token| String::from_utf8_lossy(token.bytes(text)).into_owned());
        std::iter::from_fn(next).collect()
    }

    fn words(text: &str) -> Vec<String> {
        words_of(Syntax::Scene, text.as_bytes())
    }

    #[test]
    fn words_are_separated_by_any_white_space() {
        assert_eq!(words("a\tb\u{b}c\u{c}d \u{1f} e"), ["a", "b", "c", "d", "e"]);
        assert_eq!(words("{type x}"), ["{type", "x}"]);
    }

    #[test]
    fn lines_end_in_lf_crlf_or_cr() {
        assert_eq!(words("a % x\nb % y\r\nc % z\rd"), ["a", "b", "c", "d"]);
    }

    #[test]
    fn a_quote_toggles_and_ends_the_word() {
        assert_eq!(words(r#"ab"c d"e"#), ["ab", "c d", "e"]);
        assert_eq!(words(r#"{"sRGB nonlinear"1 "#), ["{", "sRGB nonlinear", "1"]);
        assert_eq!(words(r#"" a ""#), [" a "]);
    }

    #[test]
    fn empty_quotes_yield_nothing() {
        assert_eq!(words(r#"a "" b"#), ["a", "b"]);
        assert_eq!(words("\"\""), [""; 0]);
    }

    #[test]
    fn an_unclosed_quote_ends_with_its_line() {
        assert_eq!(words("name \"a b\nc d"), ["name", "a b", "c", "d"]);
    }

    #[test]
    fn comment_signs_count_at_the_start_of_a_word_even_in_quotes() {
        assert_eq!(words("a#b c% #d e\nf"), ["a#b", "c%", "f"]);
        assert_eq!(words("x \"#y\" z\nw"), ["x", "w"]);
        assert_eq!(words("x \" #y\" z"), ["x", " #y", "z"]);
        assert_eq!(words("%% a\n## b\nc"), ["c"]);
    }

    #[test]
    fn block_comments_are_words_of_their_own() {
        assert_eq!(words("a /* b { \n c */ d"), ["a", "d"]);
        assert_eq!(words("a /*b*/ c"), ["a", "/*b*/", "c"]);
        assert_eq!(words("a /* % */ \n b */ c"), ["a", "c"]);
        assert_eq!(words("a /* /* */ b */"), ["a", "b", "*/"]);
    }

    #[test]
    fn an_unclosed_block_comment_hides_the_rest_and_is_remembered() {
        let text = b"a /* b";
        let mut lexer = Lexer::new(text, Syntax::Scene);
        assert!(lexer.next(text).is_some());
        assert!(lexer.next(text).is_none());
        assert_eq!(lexer.unclosed_comment, Some(2));
    }

    #[test]
    fn a_byte_order_mark_is_skipped() {
        assert_eq!(words("\u{feff}image"), ["image"]);
    }

    #[test]
    fn code_ends_at_its_own_line() {
        let text = b"<code>\n a \"{ \n x </code>\n \t</code> \nnext";
        let mut lexer = Lexer::new(text, Syntax::Scene);
        lexer.next(text);
        lexer.skip_code(text);
        assert_eq!(lexer.next(text).map(|token| token.bytes(text)), Some(&b"next"[..]));
        let endless = b"<code>\n a";
        let mut lexer = Lexer::new(endless, Syntax::Scene);
        lexer.next(endless);
        lexer.skip_code(endless);
        assert_eq!(lexer.next(endless), None);
    }

    #[test]
    fn commas_separate_and_hashes_stay_in_assignments() {
        assert_eq!(words_of(Syntax::Assignment, b"1,0.5, 0"), ["1", "0.5", "0"]);
        assert_eq!(words_of(Syntax::Assignment, b"#ff8000"), ["#ff8000"]);
    }

    #[test]
    fn every_byte_belongs_to_a_word_or_to_what_separates_words() {
        let text = b"image { aa 0 1 \xff\xfe } \"a b\" x # c\n\0\x01 }";
        let mut lexer = Lexer::new(text, Syntax::Scene);
        let mut end = 0;
        while let Some(token) = lexer.next(text) {
            assert!(token.start >= end && token.end > token.start);
            let gap = &text[end as usize..token.start as usize];
            assert!(gap.iter().all(|&b| b" \n\"# c".contains(&b)), "gap {gap:?}");
            end = token.end;
        }
        assert_eq!(end as usize, text.len());
    }
}
