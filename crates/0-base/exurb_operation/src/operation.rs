use std::sync::Arc;
use std::time::Instant;

use exurb_city::{City, Edit};
use exurb_geom::{Polygon, overlay};
use serde_json::Value;

use crate::{Card, Failure, Params, Run, params};

/// One operation: what it learns from examples, and how it edits a city.
pub trait Operation {
    /// Command words, paper and section, one-line summary.
    const CARD: Card;
    /// What a user may turn.
    type Params: Params;
    /// What it learns.
    type Learned;

    /// Learns from examples. O(size of the examples) for every method here.
    fn learn(
        examples: &[Example],
        params: &Self::Params,
        run: &Run,
    ) -> Result<Self::Learned, Failure>;

    /// Which examples of a library serve for `city`, by their places in it, without repetition: all of
    /// them unless the method knows how to choose.
    fn choose(
        _city: &City,
        _scope: &Scope,
        library: &[Example],
        _params: &Self::Params,
        _run: &Run,
    ) -> Result<Vec<usize>, Failure> {
        Ok((0..library.len()).collect())
    }

    /// What was learned, in figures for people; null where there is nothing to tell.
    fn describe(_learned: &Self::Learned) -> Value {
        Value::Null
    }

    /// Edits `city` inside `scope`.
    fn edit(
        city: &City,
        scope: &Scope,
        learned: &Self::Learned,
        params: &Self::Params,
        run: &Run,
    ) -> Result<Edit, Failure>;
}

/// An example: a city with a weight.
#[derive(Clone, Debug)]
pub struct Example {
    /// The city to learn from.
    pub city: Arc<City>,
    /// Its share where a method mixes; positive.
    pub weight: f64,
}

impl Example {
    /// An example of weight 1.
    pub fn new(city: impl Into<Arc<City>>) -> Self {
        Self { city: city.into(), weight: 1.0 }
    }
}

/// Where an operation may change the city; the rest stays as it is.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum Scope {
    /// Everywhere inside the city's target.
    #[default]
    All,
    /// Inside a polygon.
    Inside(Polygon),
    /// In the blocks of these numbers.
    Blocks(Vec<u32>),
}

impl Scope {
    /// Why nothing of `city` lies in this scope, or a part that is named does not; `None` where all does.
    fn misses(&self, city: &City) -> Option<String> {
        match self {
            Scope::All => None,
            Scope::Inside(area) => {
                overlay::intersection(area, &city.target).is_empty().then(|| {
                    "the scope lies outside the city; give a polygon that overlaps its target"
                        .to_owned()
                })
            }
            // A city without blocks gets them from its streets later.
            Scope::Blocks(ids) => ids
                .iter()
                .find(|id| !city.blocks.is_empty() && city.blocks.iter().all(|b| b.id != **id))
                .map(|id| format!("there is no block {id}; the layer `blocks` has the numbers")),
        }
    }
}

/// How long learning and editing took, in seconds.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Seconds {
    /// Learning from the examples.
    pub learn: f64,
    /// Editing the city.
    pub synthesise: f64,
}

/// The next city and how long it took.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// The city with the edit applied.
    pub city: City,
    /// Time taken.
    pub seconds: Seconds,
}

/// An operation without its types: parameters come as a document.
pub trait AnyOperation: Send + Sync {
    /// Command words, source, summary.
    fn card(&self) -> Card;
    /// JSON Schema of the parameters, with defaults.
    fn schema(&self) -> Value;
    /// Checks a parameter document without running.
    fn check(&self, params: &Value) -> Result<(), Failure>;
    /// Which examples of a library serve, by their places in it.
    fn choose(
        &self,
        city: &City,
        scope: &Scope,
        library: &[Example],
        params: Value,
        run: &Run,
    ) -> Result<Vec<usize>, Failure>;
    /// Learns with default parameters and describes what was learned.
    fn lesson(&self, examples: &[Example], run: &Run) -> Result<Value, Failure>;
    /// Learns, edits and applies the edit.
    fn run(
        &self,
        city: &City,
        scope: &Scope,
        examples: &[Example],
        params: Value,
        run: &Run,
    ) -> Result<Outcome, Failure>;
}

/// `O` as an [`AnyOperation`].
pub fn erase<O: Operation + 'static>() -> Box<dyn AnyOperation> {
    Box::new(Erased::<O>(std::marker::PhantomData))
}

struct Erased<O>(std::marker::PhantomData<fn() -> O>);

impl<O: Operation> Erased<O> {
    fn parse(params: Value) -> Result<O::Params, Failure> {
        params::parse(params)
            .map_err(|message| Failure::Params { operation: O::CARD.name(), message })
    }
}

impl<O: Operation> AnyOperation for Erased<O> {
    fn card(&self) -> Card {
        O::CARD
    }

    fn schema(&self) -> Value {
        params::schema::<O::Params>()
    }

    fn check(&self, params: &Value) -> Result<(), Failure> {
        Self::parse(params.clone()).map(|_| ())
    }

    fn choose(
        &self,
        city: &City,
        scope: &Scope,
        library: &[Example],
        params: Value,
        run: &Run,
    ) -> Result<Vec<usize>, Failure> {
        let run = run.named(&O::CARD.name());
        O::choose(city, scope, library, &Self::parse(params)?, &run)
    }

    fn lesson(&self, examples: &[Example], run: &Run) -> Result<Value, Failure> {
        let params = Self::parse(Value::Object(Default::default()))?;
        Ok(O::describe(&O::learn(examples, &params, &run.named(&O::CARD.name()))?))
    }

    fn run(
        &self,
        city: &City,
        scope: &Scope,
        examples: &[Example],
        params: Value,
        run: &Run,
    ) -> Result<Outcome, Failure> {
        let params = Self::parse(params)?;
        let operation = O::CARD.name();
        if O::CARD.needs_example && examples.is_empty() {
            let message = "there is no example; name one with --example FILE".to_owned();
            return Err(Failure::Example { operation, message });
        }
        if let Some(message) = scope.misses(city) {
            return Err(Failure::Params { operation, message });
        }
        let run = run.named(&operation);
        run.check()?;
        let started = Instant::now();
        let learned = O::learn(examples, &params, &run)?;
        let learn = started.elapsed().as_secs_f64();
        run.check()?;
        let started = Instant::now();
        let mut edit = O::edit(city, scope, &learned, &params, &run)?;
        for example in examples {
            edit.attribution.extend(example.city.metadata.attribution.iter().cloned());
        }
        let city = edit.apply(city);
        let synthesise = started.elapsed().as_secs_f64();
        Ok(Outcome { city, seconds: Seconds { learn, synthesise } })
    }
}
