//! The graph as `let` statements.

use std::collections::BTreeMap;

use proc_macro2::{Ident, Span, TokenStream};
use quote::{format_ident, quote};

use super::literal::Numbers;
use super::names::Names;
use super::{literal, spaced, trig};
use crate::error::Error;
use crate::graph::{Graph, Node, NodeId, Signs, Variable};

/// Expressions with more operations than this get a line of their own: beyond it nobody reads them.
const LONG: usize = 10;

/// How tightly the outermost operator of an expression binds.
#[derive(Clone, Copy, PartialEq, PartialOrd)]
enum Binding {
    Sum,
    Product,
    Unary,
    Atom,
}

struct Written {
    tokens: TokenStream,
    binding: Binding,
    operations: usize,
}

impl Written {
    fn atom(tokens: TokenStream) -> Self {
        Self { tokens, binding: Binding::Atom, operations: 0 }
    }

    /// In parentheses where it binds less tightly than its surroundings need.
    fn within(&self, least: Binding) -> TokenStream {
        let tokens = &self.tokens;
        if self.binding < least { quote!((#tokens)) } else { tokens.clone() }
    }
}

/// The parameters `q, qd, v_r, a_r`, with an underscore where the graph does not use one.
pub(super) fn parameters(graph: &Graph, joints: usize, numbers: Numbers) -> TokenStream {
    let scalar = numbers.name();
    let n = literal::count(joints);
    let used = |test: fn(&Node) -> bool| graph.nodes.iter().any(test);
    let q = used(|node| matches!(node, Node::Input(Variable::Q(_)) | Node::Sin(_) | Node::Cos(_)));
    let qd = used(|node| matches!(node, Node::Input(Variable::Qd(_))));
    let v_r = used(|node| matches!(node, Node::Input(Variable::Vr(_))));
    let a_r = used(|node| matches!(node, Node::Input(Variable::Ar(_))));
    let names = [(q, "q"), (qd, "qd"), (v_r, "v_r"), (a_r, "a_r")].map(|(used, name)| {
        if used { Ident::new(name, Span::call_site()) } else { format_ident!("_{name}") }
    });
    quote!(#(#names: &[#scalar; #n]),*)
}

/// Statements and the array of results.
pub(super) fn body(graph: &Graph, numbers: Numbers) -> Result<TokenStream, Error> {
    let (statements, outputs) = parts(graph, numbers)?;
    let outputs = spaced(outputs);
    Ok(quote!(#(#statements)* #outputs))
}

/// Statements and results.
///
/// Operators stand exactly as the graph has them: parentheses keep every rounding in its place.
pub(super) fn parts(graph: &Graph, numbers: Numbers) -> Result<(Vec<TokenStream>, Vec<TokenStream>), Error> {
    parts_with(graph, &graph.outputs, numbers)
}

/// The same with the values of `wanted` in place of the graph's results.
pub(super) fn parts_with(
    graph: &Graph,
    wanted: &[NodeId],
    numbers: Numbers,
) -> Result<(Vec<TokenStream>, Vec<TokenStream>), Error> {
    let uses = graph.uses();
    let mut names = Names::default();
    let mut statements = trigonometry(graph, &mut names, numbers)?;
    let mut written: Vec<Written> = Vec::with_capacity(graph.nodes.len());
    for (id, &node) in graph.nodes.iter().enumerate() {
        let expression = write(graph, node, &written, numbers)?;
        let leaf = node.operands().next().is_none();
        let name = graph.names.get(id).and_then(Option::as_ref);
        let own_line = name.is_some_and(|name| name.own_line) || uses[id] > 1 || expression.operations > LONG;
        if leaf || !own_line {
            names.describe(&node);
            written.push(expression);
            continue;
        }
        let ident = names.fresh(&node, name.map(|name| name.text.as_str()));
        let tokens = expression.tokens;
        statements.push(quote!(let #ident = #tokens;));
        written.push(Written::atom(quote!(#ident)));
    }
    Ok((statements, wanted.iter().map(|&output| written[output].tokens.clone()).collect()))
}

/// One call for each joint whose sine or cosine occurs.
fn trigonometry(graph: &Graph, names: &mut Names, numbers: Numbers) -> Result<Vec<TokenStream>, Error> {
    let mut joints: BTreeMap<usize, (bool, bool)> = BTreeMap::new();
    for node in &graph.nodes {
        match *node {
            Node::Sin(j) => joints.entry(j).or_default().0 = true,
            Node::Cos(j) => joints.entry(j).or_default().1 = true,
            _ => {}
        }
    }
    joints
        .into_iter()
        .map(|(j, (sin, cos))| {
            let mut part = |used: bool, function: &str| {
                let ident = format_ident!("{function}_q{}", j + 1);
                names.take(&ident.to_string());
                if used { quote!(#ident) } else { quote!(_) }
            };
            let (sin, cos) = (part(sin, "sin"), part(cos, "cos"));
            let divided = graph.parts.get(j);
            let j = literal::count(j);
            let angle = match divided {
                Some(&part) if part != 1 => {
                    let factor = numbers.float(1.0 / f64::from(part))?;
                    quote!(q[#j] * #factor)
                }
                _ => quote!(q[#j]),
            };
            let call = trig::call(&graph.sines, angle);
            Ok(quote!(let (#sin, #cos) = #call;))
        })
        .collect()
}

fn write(graph: &Graph, node: Node, written: &[Written], numbers: Numbers) -> Result<Written, Error> {
    let input = |slice: &str, j: usize| {
        let (slice, j) = (Ident::new(slice, Span::call_site()), literal::count(j));
        Written::atom(quote!(#slice[#j]))
    };
    let desired = |slice: &str, j: usize| {
        let (slice, j) = (Ident::new(slice, Span::call_site()), literal::count(j));
        Written::atom(quote!(desired.#slice[#j]))
    };
    let called = |function: TokenStream, operands: &[NodeId]| {
        let arguments = operands.iter().map(|&operand| &written[operand].tokens);
        let operations = operands.iter().map(|&operand| written[operand].operations).sum::<usize>() + 1;
        Written { tokens: quote!(#function(#(#arguments),*)), binding: Binding::Atom, operations }
    };
    let constant = |id: NodeId| matches!(graph.nodes[id], Node::Constant(_));
    let joined = |a: NodeId, b: NodeId, binding: Binding, right: Binding, operator: TokenStream| {
        let (left, right) = (written[a].within(binding), written[b].within(right));
        let operations = written[a].operations + written[b].operations + 1;
        Written { tokens: quote!(#left #operator #right), binding, operations }
    };
    Ok(match node {
        Node::Input(Variable::Q(j)) => input("q", j),
        Node::Input(Variable::Qd(j)) => input("qd", j),
        Node::Input(Variable::Vr(j)) => input("v_r", j),
        Node::Input(Variable::Ar(j)) => input("a_r", j),
        Node::Input(Variable::DesiredQ(j)) => desired("q", j),
        Node::Input(Variable::DesiredQd(j)) => desired("qd", j),
        Node::Input(Variable::DesiredQdd(j)) => desired("qdd", j),
        Node::Input(Variable::Theta(k)) => input("theta", k),
        Node::Sin(j) => named_atom(format_ident!("sin_q{}", j + 1)),
        Node::Cos(j) => named_atom(format_ident!("cos_q{}", j + 1)),
        Node::Constant(bits) => {
            let x = f64::from_bits(bits);
            let binding = if x < 0.0 { Binding::Unary } else { Binding::Atom };
            Written { tokens: numbers.float(x)?, binding, operations: 0 }
        }
        // A sum, too: a longer sum in front needs no parentheses.
        Node::Add(a, b) if written[b].binding == Binding::Sum && written[a].binding != Binding::Sum => {
            joined(b, a, Binding::Sum, Binding::Product, quote!(+))
        }
        Node::Add(a, b) => joined(a, b, Binding::Sum, Binding::Product, quote!(+)),
        Node::Sub(a, b) => joined(a, b, Binding::Sum, Binding::Product, quote!(-)),
        // A product rounds alike in either order; constants read better in front.
        Node::Mul(a, b) if constant(b) => joined(b, a, Binding::Product, Binding::Unary, quote!(*)),
        Node::Mul(a, b) => joined(a, b, Binding::Product, Binding::Unary, quote!(*)),
        Node::MulAdd(signs, a, b, added) => {
            let negated = |id: NodeId| {
                let operand = written[id].within(Binding::Atom);
                quote!(-#operand)
            };
            let plain = |id: NodeId| written[id].tokens.clone();
            // A product rounds alike in either order; constants read better in front.
            let (a, b) = if constant(b) { (b, a) } else { (a, b) };
            let (first, last) = match signs {
                Signs::Plus => (plain(a), plain(added)),
                Signs::Minus => (plain(a), negated(added)),
                Signs::From => (negated(a), plain(added)),
            };
            let second = plain(b);
            let operations = [a, b, added].map(|id| written[id].operations).iter().sum::<usize>() + 2;
            Written { tokens: quote!(mul_add(#first, #second, #last)), binding: Binding::Atom, operations }
        }
        Node::Neg(a) => {
            let operand = written[a].within(Binding::Atom);
            Written {
                tokens: quote!(-#operand),
                binding: Binding::Unary,
                operations: written[a].operations + 1,
            }
        }
        Node::Abs(a) => {
            let operand = written[a].within(Binding::Atom);
            let operations = written[a].operations + 1;
            Written { tokens: quote!(#operand.abs()), binding: Binding::Atom, operations }
        }
        Node::Clamp(a, low, high) => called(quote!(clamp), &[a, low, high]),
        Node::Select(a, above, below, otherwise) => called(quote!(select), &[a, above, below, otherwise]),
    })
}

fn named_atom(ident: Ident) -> Written {
    Written::atom(quote!(#ident))
}
