use crate::Error;
use crate::elements::Elements;
use std::io::BufRead;
pub fn read(_: impl BufRead, file: &str) -> Result<Elements, Error> {
    Err(Error::Format { file: file.to_owned() })
}
