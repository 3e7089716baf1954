//! What the recursion leaves open: equal values by different ways, of which the search takes the cheapest.

use crate::arm::{Along, Kept, Mass, Offset, Origin};

/// How one link is computed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Choice {
    /// A joint parallel to the one before turns from the frame in which that one has not turned yet, by the sum of both
    /// angles.
    pub sum: bool,
    /// Σ turns into the frame that has not turned, and the moments it gives stand there.
    pub still_sigma: bool,
    /// The same for the force that the first moment gives.
    pub still_force: bool,
    /// The same for the moment that the first moment and the acceleration of the origin give.
    pub still_pull: bool,
    /// The part of Σ that is round about z stays in the frame that has not turned.
    pub round: Round,
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
    /// What the body keeps.
    pub kept: Kept,
    /// Where its frame stands.
    pub origin: Origin,
}

impl Choice {
    /// What how the link moves depends on, besides the choice of the link before.
    pub fn motion(&self) -> (bool, Row, Diagonal, Corner, bool) {
        (self.sum, self.row, self.diagonal, self.corner, self.afresh)
    }

    /// What depends on it of what moves the body.
    pub fn wrench(&self) -> ([bool; 5], Round) {
        ([self.still_sigma, self.still_force, self.still_pull, self.mixed, self.axial], self.round)
    }
}

/// How much of Σ_xx and Σ_yy counts as round about z.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) enum Round {
    /// None.
    #[default]
    None,
    /// Σ_xx.
    X,
    /// Σ_yy.
    Y,
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
    let k = c.kept;
    let mut all = vec![
        Choice { sum: !c.sum, ..c },
        Choice { still_sigma: !c.still_sigma, ..c },
        Choice { still_force: !c.still_force, ..c },
        Choice { still_pull: !c.still_pull, ..c },
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
    all.extend([Round::None, Round::X, Round::Y].map(|round| Choice { round, ..c }));
    let kept = |kept: Kept| Choice { kept, ..c };
    all.extend([Mass::None, Mass::ForX, Mass::ForY].map(|mass| kept(Kept { mass, ..k })));
    all.extend([Offset::None, Offset::ForX, Offset::ForY].map(|offset| kept(Kept { offset, ..k })));
    all.extend([Along::None, Along::LikeX, Along::LikeY].map(|along| kept(Kept { along, ..k })));
    all.extend([Origin::Next, Origin::Before, Origin::Given].map(|origin| Choice { origin, ..c }));
    // Several at once where one alone rarely pays.
    let still = !c.still_sigma;
    all.extend([
        Choice { sum: !c.sum, still_sigma: still, still_force: still, still_pull: still, ..c },
        Choice { still_sigma: still, still_force: still, still_pull: still, ..c },
        Choice { still_force: !c.still_force, still_pull: !c.still_pull, ..c },
        Choice { diagonal: Diagonal::Turned, corner: Corner::Turned, ..c },
        Choice { diagonal: Diagonal::Turned, corner: Corner::Turned, row: Row::Still, ..c },
        Choice { diagonal: Diagonal::Turned, corner: Corner::Turned, afresh: true, ..c },
        Choice { kept: Kept { along: Along::LikeX, ..k }, mixed: !c.mixed, ..c },
        Choice { kept: Kept { along: Along::LikeY, ..k }, mixed: !c.mixed, ..c },
        Choice { kept: Kept { along: Along::LikeX, ..k }, mixed: true, round: Round::X, ..c },
        Choice { kept: Kept { along: Along::LikeY, ..k }, mixed: true, round: Round::Y, ..c },
        Choice { kept: Kept { mass: Mass::ForX, offset: Offset::ForY, ..k }, ..c },
        Choice { kept: Kept { mass: Mass::ForY, offset: Offset::ForX, ..k }, ..c },
    ]);
    all.retain(|other| other != choice);
    all
}
