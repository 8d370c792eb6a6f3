//! A small font of strokes, so that maps look alike on machines with and without fonts.
//!
//! A glyph is a list of lines on a grid; a point is two digits, column and row. Row 2 is the base
//! line, 7 the height of small letters, 9 that of capitals, 0 the depth of descenders.

/// A point in pixels, x right, y down.
type Px = [f32; 2];

const BASE_ROW: f32 = 2.0;
const CAPITAL_ROWS: f32 = 7.0;
/// Columns between letters, and of a space.
const GAP: f32 = 2.2;
const SPACE: f32 = 3.4;

/// The strokes of `text` whose capitals are `height_px` high, beginning at `at` on the base line.
pub fn strokes(text: &str, at: Px, height_px: f32) -> Vec<Vec<Px>> {
    let unit = height_px / CAPITAL_ROWS;
    let mut x = at[0];
    let mut out = Vec::new();
    for letter in text.chars().map(plain) {
        for stroke in glyph(letter).split(' ').filter(|s| !s.is_empty()) {
            let place = |p: &[u8]| {
                let digit = |b: u8| f32::from(b - b'0');
                [x + digit(p[0]) * unit, at[1] - (digit(p[1]) - BASE_ROW) * unit]
            };
            let mut line: Vec<Px> = stroke.as_bytes().chunks_exact(2).map(place).collect();
            if let [dot] = line[..] {
                line.push([dot[0], dot[1] - 0.1 * unit]);
            }
            out.push(line);
        }
        x += advance(letter) * unit;
    }
    out
}

/// Width of `text` in pixels, without the gap after its last letter.
pub fn width(text: &str, height_px: f32) -> f32 {
    let columns: f32 = text.chars().map(|c| advance(plain(c))).sum();
    (columns - GAP).max(0.0) * height_px / CAPITAL_ROWS
}

fn advance(letter: char) -> f32 {
    let columns = glyph(letter).split(' ').flat_map(|s| s.bytes().step_by(2)).max();
    columns.map_or(SPACE, |b| f32::from(b - b'0') + GAP)
}

/// The letter without its accent.
fn plain(letter: char) -> char {
    match letter {
        'À'..='Å' | 'Ā' | 'Ă' | 'Ą' => 'A',
        'à'..='å' | 'ā' | 'ă' | 'ą' => 'a',
        'Ç' | 'Ć' | 'Č' => 'C',
        'ç' | 'ć' | 'č' => 'c',
        'È'..='Ë' | 'Ē' | 'Ę' | 'Ě' => 'E',
        'è'..='ë' | 'ē' | 'ę' | 'ě' => 'e',
        'Ì'..='Ï' | 'Ī' | 'İ' => 'I',
        'ì'..='ï' | 'ī' | 'ı' => 'i',
        'Ñ' | 'Ń' | 'Ň' => 'N',
        'ñ' | 'ń' | 'ň' => 'n',
        'Ò'..='Ö' | 'Ø' | 'Ō' | 'Ő' => 'O',
        'ò'..='ö' | 'ø' | 'ō' | 'ő' => 'o',
        'Ś' | 'Š' | 'Ş' => 'S',
        'ś' | 'š' | 'ş' => 's',
        'Ù'..='Ü' | 'Ū' | 'Ů' => 'U',
        'ù'..='ü' | 'ū' | 'ů' => 'u',
        'Ý' => 'Y',
        'ý' | 'ÿ' => 'y',
        'Ź' | 'Ż' | 'Ž' => 'Z',
        'ź' | 'ż' | 'ž' => 'z',
        'Ł' => 'L',
        'ł' => 'l',
        '‘' | '’' => '\'',
        '“' | '”' => '"',
        '—' => '–',
        other => other,
    }
}

fn glyph(letter: char) -> &'static str {
    match letter {
        'A' => "022942 1535",
        'B' => "02093948473606 3645433202",
        'C' => "4839190803123243",
        'D' => "02092947442202",
        'E' => "49090242 0636",
        'F' => "490902 0636",
        'G' => "48391908031232434525",
        'H' => "0209 4249 0646",
        'I' => "0209",
        'J' => "3933221203",
        'K' => "0209 4905 1642",
        'L' => "090242",
        'M' => "0209254942",
        'N' => "02094249",
        'O' => "190803123243483919",
        'P' => "02093948463505",
        'Q' => "190803123243483919 2442",
        'R' => "02093948463505 2542",
        'S' => "483919080716364543321203",
        'T' => "0949 2922",
        'U' => "090312324349",
        'V' => "092249",
        'W' => "0912263249",
        'X' => "0249 0942",
        'Y' => "092549 2522",
        'Z' => "09490242",
        'a' => "3732 3627170603122233",
        'b' => "0209 0617273633221203",
        'c' => "3627170603122233",
        'd' => "3932 3627170603122233",
        'e' => "05353627170603122233",
        'f' => "291812 0727",
        'g' => "37312010 3627170603122233",
        'h' => "0209 0617273632",
        'i' => "0207 09",
        'j' => "171100 19",
        'k' => "0209 3704 1532",
        'l' => "0209",
        'm' => "0207 06172622 26374642",
        'n' => "0207 0617273632",
        'o' => "170603122233362717",
        'p' => "0007 0617273633221203",
        'q' => "3037 3627170603122233",
        'r' => "0207 051727",
        's' => "3627170633221203",
        't' => "191322 0727",
        'u' => "0703122233 3732",
        'v' => "072247",
        'w' => "0712263247",
        'x' => "0237 0732",
        'y' => "0722 4710",
        'z' => "07370232",
        'ß' => "0208192938372635332212",
        '0' => "190803122233382919",
        '1' => "081912",
        '2' => "08192938360232",
        '3' => "08192938372616 263533221203",
        '4' => "32390444",
        '5' => "390906263533221203",
        '6' => "3829190803122233352606",
        '7' => "093912",
        '8' => "190807162637382919 1605031222333526",
        '9' => "0312223338291908061535",
        ' ' => "",
        '.' => "02",
        ',' => "1200",
        ':' => "02 06",
        ';' => "1200 16",
        '!' => "0904 02",
        '?' => "08192938372524 22",
        '-' => "0525",
        '–' => "0545",
        '_' => "0141",
        '+' => "0545 2723",
        '=' => "0646 0444",
        '<' => "380532",
        '>' => "083502",
        '/' => "0139",
        '\\' => "0931",
        '|' => "0109",
        '(' => "19070311",
        ')' => "09171301",
        '[' => "19090111",
        ']' => "09191101",
        '\'' => "0907",
        '"' => "0907 2927",
        '&' => "4217182938370403122244",
        '%' => "0249 08 43",
        '#' => "1219 3239 0747 0444",
        '*' => "2925 0848 0646",
        '·' => "05",
        '°' => "1908172819",
        '@' => "463726253445464544 67492907042242",
        '©' => "290704224264674929 463726253445",
        _ => "0209393202",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn glyphs_are_pairs_of_digits() {
        for letter in ('!'..='~').chain("©·°–ß□".chars()) {
            for stroke in glyph(letter).split(' ') {
                assert_eq!(stroke.len() % 2, 0, "{letter}: {stroke}");
                assert!(stroke.bytes().all(|b| b.is_ascii_digit()), "{letter}: {stroke}");
            }
        }
    }

    #[test]
    fn a_word_is_as_wide_as_its_strokes() {
        let strokes = strokes("Hamburg", [0.0, 0.0], 7.0);
        let right = strokes.iter().flatten().map(|p| p[0]).fold(0.0, f32::max);
        assert!((right - width("Hamburg", 7.0)).abs() < 1e-3);
    }
}
