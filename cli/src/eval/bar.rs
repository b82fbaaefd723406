//! A line on the terminal that shows how far a long evaluation is.

use std::io::{self, IsTerminal, Write};
use std::time::{Duration, Instant};

/// Shows a count on standard error if that is a terminal, and nothing otherwise.
#[derive(Debug)]
pub(crate) struct Bar {
    shown: bool,
    total: Option<usize>,
    last: Option<Instant>,
}

impl Bar {
    /// A bar for `total` steps, or for an unknown number.
    pub(crate) fn new(total: Option<usize>) -> Self {
        Self {
            shown: io::stderr().is_terminal(),
            total,
            last: None,
        }
    }

    /// Shows that `done` steps are done, ten times a second at most.
    pub(crate) fn advance(&mut self, done: usize) {
        let recent = |at: Instant| at.elapsed() < Duration::from_millis(100);
        if !self.shown || self.last.is_some_and(recent) {
            return;
        }
        self.last = Some(Instant::now());
        // A terminal that cannot be written to is no reason to stop measuring.
        write!(io::stderr(), "\r{}", line(done, self.total)).ok();
        io::stderr().flush().ok();
    }

    /// Removes the line.
    pub(crate) fn clear(&mut self) {
        if self.shown && self.last.take().is_some() {
            write!(io::stderr(), "\r\x1b[K").ok();
        }
    }
}

fn line(done: usize, total: Option<usize>) -> String {
    const WIDTH: usize = 30;
    match total {
        Some(total) if total > 0 => {
            let full = (WIDTH * done.min(total)) / total;
            let bar: String = (0..WIDTH)
                .map(|i| if i < full { '#' } else { '.' })
                .collect();
            format!("[{bar}] {done} of at most {total} drawings")
        }
        _ => format!("{done} drawings"),
    }
}

#[cfg(test)]
mod tests {
    use super::line;

    #[test]
    fn the_bar_fills() {
        assert!(line(5, Some(10)).starts_with("[###############..............."));
        assert!(line(99, Some(10)).contains("[##############################]"));
        assert_eq!(line(3, None), "3 drawings");
        assert_eq!(line(0, Some(0)), "0 drawings");
    }
}
