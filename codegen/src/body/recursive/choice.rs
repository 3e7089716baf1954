//! What the recursion leaves open: equal values by different ways, of which the search takes the cheapest.

use crate::arm::{Along, Mass, Origin};

/// How one link is computed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Choice {
    /// A joint parallel to the one before turns from the frame in which that one has not turned yet, by the sum of both
    /// angles.
    pub sum: bool,
    /// The body's wrench stands in the frame that has not turned, and its parameters turn instead.
    pub still_body: bool,
    /// The lever to the next joint is swept in the frame that has not turned.
    pub still_lever: bool,
    /// Last row of the gradient.
    pub row: Row,
    /// Entries xx and yy of the gradient.
    pub diagonal: Diagonal,
    /// Entries xy and yx of the gradient.
    pub corner: Corner,
    /// The still gradient comes from velocities and not from the gradient before.
    pub afresh: bool,
    /// Moments along x and y by the mixed velocity products.
    pub mixed: bool,
    /// Moment along z by the mixed velocity product and the angular acceleration.
    pub axial: bool,
    /// What the body keeps of its mass.
    pub mass: Mass,
    /// What the body keeps of its Σ_zz.
    pub along: Along,
    /// Where its frame stands.
    pub origin: Origin,
}

/// Ways to the last row of the gradient, which is not that of the parent.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) enum Row {
    /// 2xz less the last column, in the turned frame.
    #[default]
    Turned,
    /// The same in the still frame, then turned.
    Still,
    /// The parent's with the joint's own motion added, then turned.
    Parent,
}

/// Ways to the squares of velocity.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) enum Diagonal {
    /// From y², z² and the parent's x² + y².
    #[default]
    Trace,
    /// From x², y² and z².
    Squares,
    /// From the still gradient, turned.
    Turned,
}

/// Ways to the entries xy and yx.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) enum Corner {
    /// One from the sum and the difference of both, the other from the sum.
    #[default]
    Sum,
    /// Half the sum plus and minus the angular acceleration.
    Halves,
    /// From the still gradient, turned.
    Turned,
}

/// Every other choice for one link that differs from `choice` in one respect, in a fixed order.
pub(super) fn neighbours(choice: &Choice) -> Vec<Choice> {
    let c = *choice;
    let mut all = vec![
        Choice { sum: !c.sum, ..c },
        Choice { still_body: !c.still_body, ..c },
        Choice { still_lever: !c.still_lever, ..c },
        Choice { afresh: !c.afresh, ..c },
        Choice { mixed: !c.mixed, ..c },
        Choice { axial: !c.axial, ..c },
    ];
    all.extend([Row::Turned, Row::Still, Row::Parent].map(|row| Choice { row, ..c }));
    all.extend(
        [Diagonal::Trace, Diagonal::Squares, Diagonal::Turned].map(|diagonal| Choice { diagonal, ..c }),
    );
    all.extend([Corner::Sum, Corner::Halves, Corner::Turned].map(|corner| Choice { corner, ..c }));
    all.extend([Mass::None, Mass::ForX, Mass::ForY].map(|mass| Choice { mass, ..c }));
    all.extend([Along::None, Along::LikeX, Along::LikeY].map(|along| Choice { along, ..c }));
    all.extend([Origin::Next, Origin::Before, Origin::Given].map(|origin| Choice { origin, ..c }));
    // Two at once where one alone rarely pays.
    all.extend([
        Choice { sum: !c.sum, still_body: !c.still_body, ..c },
        Choice { diagonal: Diagonal::Turned, corner: Corner::Turned, ..c },
        Choice { diagonal: Diagonal::Turned, corner: Corner::Turned, row: Row::Still, ..c },
        Choice { diagonal: Diagonal::Turned, corner: Corner::Turned, afresh: true, ..c },
        Choice { along: Along::LikeX, mixed: !c.mixed, ..c },
        Choice { along: Along::LikeY, mixed: !c.mixed, ..c },
    ]);
    all.retain(|other| other != choice);
    all
}
