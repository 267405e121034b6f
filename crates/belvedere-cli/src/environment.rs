//! Settings from arguments and the environment: threads, instructions of the processor, and the folder of kept scenes.

use crate::arguments::{Global, MAX_THREADS, refuse};
use anyhow::{Result, anyhow};
use belvedere::cache::SceneCache;
use belvedere::io::hidden_text;
use belvedere::neighbors::Instructions;
use std::env;
use std::ffi::OsString;

/// Threads, as other programs with the same library have it.
const THREADS: &str = "RAYON_NUM_THREADS";
/// Use of AVX2 if the processor has it: on or off.
const AVX2: &str = "BELVEDERE_AVX2";

/// The words that were typed. Addresses in them are without user, password and key from here on, so that nothing that
/// is printed or written can have any.
pub(crate) fn words() -> Vec<OsString> {
    env::args_os().map(|word| word.to_str().and_then(hidden_text).map_or(word, OsString::from)).collect()
}

/// Makes the threads of the program, and turns AVX2 off where that is wanted.
///
/// # Errors
/// [`Usage`] for what a variable cannot be; what the system says where it refuses a thread.
pub(crate) fn apply(global: &Global) -> Result<()> {
    match env::var(AVX2).as_deref() {
        Err(_) | Ok("" | "on") => {}
        Ok("off") => Instructions::turn_avx2_off(),
        Ok(other) => return refuse(format!("the variable {AVX2} is {other:?}, but must be on or off")),
    }
    let threads = match global.threads {
        Some(threads) => threads,
        None => threads_of(env::var(THREADS).ok().as_deref())?,
    };
    rayon::ThreadPoolBuilder::new().num_threads(threads).build_global().map_err(|error| {
        let count = if threads == 0 { "as many threads as there are processors".to_owned() } else { threads.to_string() };
        anyhow!("the system refuses {count} ({error}); give fewer with --threads, or raise its limits (ulimit -u, ulimit -v)")
    })
}

/// Returns the cache of scenes; `None` if it is not wanted, or no folder is known.
pub(crate) fn cache(global: &Global) -> Option<SceneCache> {
    if global.no_cache {
        return None;
    }
    global.cache.clone().or_else(|| SceneCache::usual_folder(|name| env::var_os(name))).map(SceneCache::new)
}

/// Threads that the variable names, 0 for all processors: what is no number is passed over, as the library does it.
fn threads_of(variable: Option<&str>) -> Result<usize> {
    let threads = variable.and_then(|text| text.trim().parse::<u64>().ok()).unwrap_or(0);
    match usize::try_from(threads) {
        Ok(threads) if threads <= MAX_THREADS => Ok(threads),
        _ => refuse(format!("the variable {THREADS} is {threads}, but must be at most {MAX_THREADS}")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::arguments::Usage;

    #[test]
    fn threads_of_the_environment_are_bounded() {
        for (text, expected) in
            [(None, 0), (Some(""), 0), (Some("x"), 0), (Some("-3"), 0), (Some(" 7 "), 7), (Some("1024"), 1024)]
        {
            assert_eq!(threads_of(text).unwrap(), expected, "{text:?}");
        }
        for text in ["1025", "18446744073709551615"] {
            let error = threads_of(Some(text)).unwrap_err();
            assert!(error.is::<Usage>() && error.to_string().contains("at most 1024"), "{error}");
        }
    }
}
