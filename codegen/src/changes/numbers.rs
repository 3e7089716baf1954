//! The numbers of a module by name: those of its constants, and the parameters of its model.

use std::collections::{BTreeMap, BTreeSet};

use quote::ToTokens;
use syn::{BinOp, Expr, ImplItem, Item, Lit, Member, Pat, Stmt, UnOp};

/// Numbers by name, such as `BOUNDS.d[0][1]`, or `d11: cos_q2` for what multiplies cos q2 in d11.
pub type Numbers = BTreeMap<String, f64>;

/// The method that computes the model.
const MODEL: &str = "passivity_torque";

/// Every number with a decimal point in the constants and in the model of the module `text`.
pub(super) fn numbers(text: &str) -> Result<Numbers, syn::Error> {
    let mut out = Numbers::new();
    for item in syn::parse_file(text)?.items {
        match item {
            Item::Const(item) => constant(&item.ident.to_string(), &item.expr, &mut out),
            Item::Impl(item) => {
                let model = item.items.iter().filter_map(|item| match item {
                    ImplItem::Fn(method) if method.sig.ident == MODEL => Some(&method.block.stmts),
                    _ => None,
                });
                let mut sums = Sums::default();
                model.flatten().for_each(|statement| sums.take(statement));
                sums.numbers(&mut out);
            }
            _ => {}
        }
    }
    Ok(out)
}

/// The numbers in the value of a constant.
fn constant(name: &str, value: &Expr, out: &mut Numbers) {
    match value {
        Expr::Array(array) => {
            for (i, value) in array.elems.iter().enumerate() {
                constant(&format!("{name}[{i}]"), value, out);
            }
        }
        Expr::Struct(fields) => {
            for field in &fields.fields {
                if let Member::Named(member) = &field.member {
                    constant(&format!("{name}.{member}"), &field.expr, out);
                }
            }
        }
        Expr::Call(call) => call.args.iter().for_each(|value| constant(name, value, out)),
        Expr::Paren(inner) => constant(name, &inner.expr, out),
        value => {
            if let Some(number) = number(value) {
                out.insert(name.to_string(), number);
            }
        }
    }
}

/// The number that `value` is; `None` for whole numbers, which count something.
fn number(value: &Expr) -> Option<f64> {
    match value {
        Expr::Lit(literal) => match &literal.lit {
            Lit::Float(float) => float.base10_digits().parse().ok(),
            _ => None,
        },
        Expr::Unary(unary) if matches!(unary.op, UnOp::Neg(_)) => Some(-number(&unary.expr)?),
        Expr::Paren(inner) => number(&inner.expr),
        _ => None,
    }
}

/// How the names of sums begin that several coefficients share: such names change with the sums.
const SHARED: &str = "t_";

/// What multiplies what in the sums of a model, by their names.
#[derive(Default)]
struct Sums {
    sums: BTreeMap<String, Vec<(String, f64)>>,
    /// Shared sums that others have taken in.
    taken: BTreeSet<String>,
}

impl Sums {
    /// Takes in `let name = sum`. Terms without a number are no parameters; a shared sum alone counts as its terms.
    fn take(&mut self, statement: &Stmt) {
        let Stmt::Local(local) = statement else { return };
        let (Pat::Ident(name), Some(value)) = (&local.pat, &local.init) else { return };
        let (mut terms, mut found) = (Vec::new(), Vec::new());
        sum(&value.expr, 1.0, &mut terms);
        for (sign, term) in terms {
            let (mut product, mut factors) = (None, Vec::new());
            factor(term, &mut product, &mut factors);
            let scale = sign * product.unwrap_or(1.0);
            match (factors.as_slice(), product) {
                ([one], _) if one.starts_with(SHARED) && self.sums.contains_key(one) => {
                    self.taken.insert(one.clone());
                    found.extend(self.sums[one].iter().map(|(of, number)| (of.clone(), scale * number)));
                }
                ([], Some(_)) => found.push(("1".to_string(), scale)),
                (_, Some(_)) => found.push((factors.join(" "), scale)),
                (_, None) => {}
            }
        }
        if !found.is_empty() {
            self.sums.insert(name.ident.to_string(), found);
        }
    }

    fn numbers(self, out: &mut Numbers) {
        for (name, terms) in self.sums.into_iter().filter(|(name, _)| !self.taken.contains(name)) {
            for (of, number) in terms {
                *out.entry(format!("{name}: {of}")).or_insert(0.0) += number;
            }
        }
    }
}

/// The terms of a sum, each with its sign.
fn sum<'a>(value: &'a Expr, sign: f64, out: &mut Vec<(f64, &'a Expr)>) {
    match value {
        Expr::Binary(binary) if matches!(binary.op, BinOp::Add(_) | BinOp::Sub(_)) => {
            sum(&binary.left, sign, out);
            sum(&binary.right, if matches!(binary.op, BinOp::Sub(_)) { -sign } else { sign }, out);
        }
        value => out.push((sign, value)),
    }
}

/// The number in a product, if there is one, and the other factors as text.
fn factor(value: &Expr, product: &mut Option<f64>, factors: &mut Vec<String>) {
    match value {
        Expr::Binary(binary) if matches!(binary.op, BinOp::Mul(_)) => {
            factor(&binary.left, product, factors);
            factor(&binary.right, product, factors);
        }
        value => match number(value) {
            Some(number) => *product = Some(product.unwrap_or(1.0) * number),
            None => factors.push(value.to_token_stream().to_string().replace(' ', "")),
        },
    }
}

#[cfg(test)]
mod tests {
    use super::numbers;

    #[test]
    fn numbers_have_names() {
        let text = "pub const N: usize = 3;\n\
                    pub const B: S = S { d: [[0.5, -2.0]], p: Some(1e-3), n: None };\n\
                    impl Model for M { fn passivity_torque(&self) { let d11 = 3.0 * cos_q2 - 0.5 * sin_q2 * x + 2.0; } }";
        let found: Vec<(String, f64)> = numbers(text).unwrap().into_iter().collect();
        let expected = [
            ("B.d[0][0]", 0.5),
            ("B.d[0][1]", -2.0),
            ("B.p", 1e-3),
            ("d11: 1", 2.0),
            ("d11: cos_q2", 3.0),
            ("d11: sin_q2 x", -0.5),
        ];
        assert_eq!(found, expected.map(|(name, value)| (name.to_string(), value)));
        assert!(numbers("pub const").is_err());
    }

    #[test]
    fn a_sum_that_is_shared_counts_where_it_stands() {
        let body = |lines: &str| {
            numbers(&format!("impl Model for M {{ fn passivity_torque(&self) {{ {lines} }} }}")).unwrap()
        };
        let shared =
            body("let t_1a = 3.0 * cos_q2 + 1.0; let g2 = 2.0 * t_1a - x; let g3 = t_1a + 0.5 * sin_q2;");
        let apart = body("let g2 = 6.0 * cos_q2 + 2.0 - x; let g3 = 3.0 * cos_q2 + 1.0 + 0.5 * sin_q2;");
        assert_eq!(shared, apart);
        assert_eq!(body("let t_1a = 3.0 * cos_q2; let tau1 = t_1a * x;").len(), 1);
    }
}
