//! The page, embedded in the program.

/// Type and content of a file of the page.
pub(crate) fn file(path: &str) -> Option<(&'static str, &'static [u8])> {
    match path {
        "" | "index.html" => Some(("text/html; charset=utf-8", include_bytes!("../page/index.html"))),
        "style.css" => Some(("text/css; charset=utf-8", include_bytes!("../page/style.css"))),
        "page.js" => Some(("text/javascript; charset=utf-8", include_bytes!("../page/page.js"))),
        "icon.svg" => Some(("image/svg+xml", include_bytes!("../page/icon.svg"))),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::file;

    #[test]
    fn the_page_weighs_less_than_a_megabyte_and_fetches_nothing_from_elsewhere() {
        let files = ["index.html", "style.css", "page.js", "icon.svg"].map(|path| file(path).unwrap().1);
        assert!(files.iter().map(|file| file.len()).sum::<usize>() < 1_000_000);
        for of_ours in &files[..2] {
            let text = std::str::from_utf8(of_ours).unwrap();
            assert!(!text.contains("http:") && !text.contains("https:") && !text.contains("//"), "{text}");
        }
    }
}
