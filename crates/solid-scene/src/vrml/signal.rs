//! Following events back from the field that receives them to the sensors.

use std::collections::HashMap;

use super::graph::{Graph, Node, Slot};
use super::interpolator::{Event, Interpolator, is_interpolator};
use super::limits::{CHAIN_MAX, ELEMENTS_MAX};
use super::route::Routes;
use super::scan::as_written;
use super::sensor::Sensor;
use crate::error::SceneError;
use crate::text::quoted;
use crate::warnings::Warnings;

/// A signal, by its place in [`Signals`].
pub(super) type SignalId = usize;

/// An event, and when it was sent.
#[derive(Clone, Debug)]
struct Sent {
    time: f64,
    event: Event,
}

/// What a field receives, as a function of time.
#[derive(Clone, Debug)]
enum Signal {
    /// The fraction of a sensor.
    Fraction(Sensor),
    /// An interpolator and what drives it.
    Interpolated(Interpolator, SignalId),
    /// What was sent last by one of several; of what was sent at one time, that of the last.
    Last(Vec<SignalId>),
}

/// The signals of a scene, each after those that it depends on.
#[derive(Debug, Default)]
pub(super) struct Signals {
    signals: Vec<Signal>,
}

impl Signals {
    /// Evaluates all signals at a time; `None` for those that have sent nothing yet.
    pub fn at(&self, time: f64) -> Vec<Option<Event>> {
        let mut sent: Vec<Option<Sent>> = Vec::with_capacity(self.signals.len());
        for signal in &self.signals {
            let event = signal.at(time, &sent);
            sent.push(event);
        }
        sent.into_iter().map(|sent| Some(sent?.event)).collect()
    }
}

impl Signal {
    fn at(&self, time: f64, sent: &[Option<Sent>]) -> Option<Sent> {
        match self {
            Signal::Fraction(sensor) => {
                let event = Event::Number(sensor.fraction(time)?);
                Some(Sent { time: time.min(sensor.end()), event })
            }
            Signal::Interpolated(interpolator, input) => match sent[*input] {
                Some(Sent { time, event: Event::Number(fraction) }) => {
                    Some(Sent { time, event: interpolator.at(fraction) })
                }
                _ => None,
            },
            Signal::Last(inputs) => {
                let sent = inputs.iter().filter_map(|&input| sent[input].as_ref());
                sent.max_by(|a, b| a.time.total_cmp(&b.time)).cloned()
            }
        }
    }
}

/// Builds the signals that fields ask for.
pub(super) struct SignalBuilder<'a> {
    graph: &'a Graph,
    routes: &'a Routes,
    signals: Signals,
    /// For each signal, how many points its events hold.
    point_counts: Vec<Option<usize>>,
    /// What the signals send at time 0.
    start: Vec<Option<Sent>>,
    /// The signal of each field asked for; `Pending` while it is being followed.
    known: HashMap<Slot, Known>,
    depth: usize,
    elements: usize,
}

#[derive(Clone, Copy)]
enum Known {
    Pending,
    Found(Option<SignalId>),
}

impl<'a> SignalBuilder<'a> {
    /// Starts without any signal.
    pub fn new(graph: &'a Graph, routes: &'a Routes) -> Self {
        SignalBuilder {
            graph,
            routes,
            signals: Signals::default(),
            point_counts: Vec::new(),
            start: Vec::new(),
            known: HashMap::new(),
            depth: 0,
            elements: 0,
        }
    }

    /// The signal that a field receives; `None` when no sensor drives it.
    pub fn driving(
        &mut self,
        node: Node,
        field: &str,
        warnings: &mut Warnings,
    ) -> Result<Option<SignalId>, SceneError> {
        let slot = (node, field.to_owned());
        if self.routes.sources(&slot).is_empty() {
            return Ok(None);
        }
        match self.known.get(&slot) {
            Some(Known::Found(signal)) => return Ok(*signal),
            Some(Known::Pending) => {
                warnings
                    .add(format!("{}: a loop of ROUTEs through {field} is cut", self.graph.describe(node)));
                return Ok(None);
            }
            None => {}
        }
        if self.depth == CHAIN_MAX {
            return Err(self.graph.error(node, format!("more than {CHAIN_MAX} ROUTEs in a chain lead here")));
        }
        self.known.insert(slot.clone(), Known::Pending);
        self.depth += 1;
        let mut inputs = Vec::new();
        for (source, event) in self.routes.sources(&slot) {
            inputs.extend(self.out_of(*source, event, warnings)?);
        }
        self.depth -= 1;
        let signal = match inputs.as_slice() {
            [] => None,
            [input] => Some(*input),
            _ => Some(self.add(Signal::Last(inputs))),
        };
        self.known.insert(slot, Known::Found(signal));
        Ok(signal)
    }

    /// What a signal sends at time 0.
    pub fn start(&self, signal: SignalId) -> Option<&Event> {
        self.start[signal].as_ref().map(|sent| &sent.event)
    }

    /// How many points each event of a signal holds; `None` when that changes.
    pub fn point_count(&self, signal: SignalId) -> Option<usize> {
        self.point_counts[signal]
    }

    /// The signals.
    pub fn finish(self) -> Signals {
        self.signals
    }

    /// The signal that leaves a field.
    fn out_of(
        &mut self,
        node: Node,
        event: &str,
        warnings: &mut Warnings,
    ) -> Result<Option<SignalId>, SceneError> {
        let type_name = self.graph.type_name(node);
        match event {
            "fraction_changed" if type_name == "TimeSensor" => self.once(node, event, |builder| {
                let sensor = Sensor::read(builder.graph, node)?;
                Ok(Some(builder.add(Signal::Fraction(sensor))))
            }),
            "value_changed" if is_interpolator(type_name) => {
                let Some(input) = self.driving(node, "set_fraction", warnings)? else { return Ok(None) };
                self.once(node, event, |builder| builder.interpolated(node, input))
            }
            _ if self.graph.document(node).passes_events(node.syntax, event) => {
                self.driving(node, event, warnings)
            }
            _ => {
                let plain = if type_name.is_empty() { "a node that is not known" } else { type_name };
                warnings.add(format!("events {} of {plain} are not followed", quoted(&as_written(event))));
                Ok(None)
            }
        }
    }

    /// The signal that leaves a field, made when it is first asked for.
    fn once(
        &mut self,
        node: Node,
        event: &str,
        make: impl FnOnce(&mut Self) -> Result<Option<SignalId>, SceneError>,
    ) -> Result<Option<SignalId>, SceneError> {
        let slot = (node, event.to_owned());
        if let Some(Known::Found(signal)) = self.known.get(&slot) {
            return Ok(*signal);
        }
        let signal = make(self)?;
        self.known.insert(slot, Known::Found(signal));
        Ok(signal)
    }

    fn interpolated(&mut self, node: Node, input: SignalId) -> Result<Option<SignalId>, SceneError> {
        self.elements += self.graph.count(node, "keyValue");
        if self.elements > ELEMENTS_MAX {
            return Err(self.graph.error(node, format!("more than {ELEMENTS_MAX} values to interpolate")));
        }
        let interpolator = Interpolator::read(self.graph, node)?;
        Ok(interpolator.map(|interpolator| self.add(Signal::Interpolated(interpolator, input))))
    }

    fn add(&mut self, signal: Signal) -> SignalId {
        let point_count = match &signal {
            Signal::Fraction(_) => Some(0),
            Signal::Interpolated(interpolator, _) => Some(interpolator.point_count()),
            Signal::Last(inputs) => {
                let first = inputs.first().and_then(|&input| self.point_counts[input]);
                first.filter(|_| inputs.iter().all(|&input| self.point_counts[input] == first))
            }
        };
        self.point_counts.push(point_count);
        self.start.push(signal.at(0.0, &self.start));
        self.signals.signals.push(signal);
        self.signals.signals.len() - 1
    }
}
