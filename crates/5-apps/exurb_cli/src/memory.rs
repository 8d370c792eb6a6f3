//! How much memory the program uses (Linux).

/// A message when the program uses more than `limit` bytes. Learned from `/proc/self/status`, which
/// other systems lack: there the option is refused.
pub fn over(limit: u64) -> Option<String> {
    let used = used()?;
    (used > limit).then(|| {
        format!(
            "memory use of {} passed --max-memory {}; take a smaller target or example, or raise the limit",
            mebibytes(used),
            mebibytes(limit)
        )
    })
}

fn used() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmRSS:"))?;
    let kilobytes: u64 = line.trim().trim_end_matches("kB").trim().parse().ok()?;
    Some(kilobytes * 1024)
}

fn mebibytes(bytes: u64) -> String {
    format!("{} MiB", bytes >> 20)
}
