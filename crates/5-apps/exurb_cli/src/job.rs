//! One piece of work: its threads, its progress on the terminal, Ctrl-C, its limit of memory.

use std::io::IsTerminal;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::{self, JoinHandle};
use std::time::Duration;

use exurb_operation::Run;
use indicatif::{ProgressBar, ProgressStyle};

use crate::memory;
use crate::options::RunOptions;
use crate::problem::Problem;
use crate::report;

/// How often progress, memory and the end of the work are looked at.
const TICK: Duration = Duration::from_millis(50);

/// Does `work` on a pool of its own. Progress goes to standard error when that is a terminal;
/// Ctrl-C cancels the run; warnings are printed at the end.
pub fn work<T: Send>(
    options: &RunOptions,
    seed: u64,
    work: impl FnOnce(&Run) -> Result<T, Problem> + Send,
) -> Result<T, Problem> {
    let threads = options.threads.map_or(0, usize::from);
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(threads)
        .build()
        .map_err(|e| Problem::failed(format!("no threads to work on: {e}; try --threads 1")))?;
    let run = Run::new(seed);
    let on_interrupt = run.clone();
    // A handler can be set once in a process: tests of this function share the first one.
    let _ = ctrlc::set_handler(move || on_interrupt.cancel());
    let watch = Watch::start(&run, options);
    let result = pool.install(|| work(&run));
    let over_limit = watch.stop();
    if !options.quiet {
        report::warnings(&run.take_warnings());
    }
    match (result, over_limit) {
        (Err(_), Some(message)) => Err(Problem::failed(message)),
        (Err(problem), None) if run.is_cancelled() && problem.message == "cancelled" => {
            Err(Problem::failed("stopped; nothing was written"))
        }
        (result, _) => result,
    }
}

/// The thread that looks after the work while it goes on.
struct Watch {
    ended: Arc<AtomicBool>,
    thread: JoinHandle<Option<String>>,
}

impl Watch {
    fn start(run: &Run, options: &RunOptions) -> Self {
        let ended = Arc::new(AtomicBool::new(false));
        let (run, limit, end) = (run.clone(), options.max_memory, ended.clone());
        let bar = (!options.quiet && std::io::stderr().is_terminal()).then(ProgressBar::no_length);
        let thread = thread::spawn(move || {
            let mut over = None;
            while !end.load(Ordering::Relaxed) {
                if let Some(bar) = &bar {
                    show(bar, &run);
                }
                if let (Some(limit), None) = (limit, &over) {
                    over = memory::over(limit);
                    if over.is_some() {
                        run.cancel();
                    }
                }
                thread::park_timeout(TICK);
            }
            if let Some(bar) = &bar {
                bar.finish_and_clear();
            }
            over
        });
        Self { ended, thread }
    }

    /// Ends the thread; the message when memory ran over its limit.
    fn stop(self) -> Option<String> {
        self.ended.store(true, Ordering::Relaxed);
        self.thread.thread().unpark();
        self.thread.join().ok().flatten()
    }
}

/// A bar where the phase tells how much there is to do, else its name and the time alone.
fn show(bar: &ProgressBar, run: &Run) {
    let (phase, done, total) = run.status();
    let template = match total {
        0 => "{spinner} {msg} {elapsed}",
        _ => "{spinner} {msg} {bar:30} {percent} % {elapsed}",
    };
    if let Ok(style) = ProgressStyle::with_template(template) {
        bar.set_style(style);
    }
    bar.set_message(phase);
    bar.set_length(u64::from(total));
    bar.set_position(u64::from(done));
    bar.tick();
}
