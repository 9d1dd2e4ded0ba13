//! The seam between the loop and the ways to find a Newton direction.

use std::ops::{Deref, DerefMut};

use super::newton::Newton;
use super::paper::PaperSystem;
use super::point::Point;
use super::program::Program;

/// How the Newton direction is found. All of them find the same one; they differ in time and in the digits they lose.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Backend {
    /// The block sweep over the stages, in square roots: ours.
    #[default]
    Block,
    /// Method I of the paper: sparse LDL^T of the reduced matrix of P4, one symbolic analysis per shape.
    SparseLdl,
    /// Method II: the dense inverse of the reduced matrix, n_X x n_X.
    DenseReduced,
    /// Method III: the dense inverse of the whole KKT matrix, (n_X + 2 n_A) x (n_X + 2 n_A).
    DenseKkt,
}

impl Backend {
    /// Every backend, ours first, then in the paper's order.
    pub const ALL: [Self; 4] = [Self::Block, Self::SparseLdl, Self::DenseReduced, Self::DenseKkt];

    /// Name in tables and files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Block => "block",
            Self::SparseLdl => "sparse-ldl",
            Self::DenseReduced => "dense-reduced",
            Self::DenseKkt => "dense-kkt",
        }
    }
}

/// The Newton system by the chosen backend. Residuals and targets are [`Newton`]'s for all of them.
#[derive(Clone, Debug)]
pub struct NewtonSystem {
    newton: Newton,
    /// The paper's way, where it is asked for.
    paper: Option<PaperSystem>,
}

impl NewtonSystem {
    /// Room for programmes like `program`.
    pub fn new(program: &Program, backend: Backend) -> Self {
        Self { newton: Newton::new(program), paper: PaperSystem::new(program, backend) }
    }

    /// To be called before each solve.
    pub fn begin(&mut self, program: &Program) {
        if let Some(paper) = &mut self.paper {
            paper.begin(program);
        }
    }

    /// See [`Newton::factor`].
    pub fn factor(&mut self, program: &Program, point: &Point) {
        match &mut self.paper {
            None => self.newton.factor(program, point),
            Some(paper) => {
                self.newton.inverse.set_inverse(point);
                paper.factor(point);
            }
        }
    }

    /// See [`Newton::direction`].
    pub fn direction(&mut self, program: &Program, point: &Point, step: &mut Point) {
        match &mut self.paper {
            None => self.newton.direction(program, point, step),
            Some(paper) => paper.direction(&self.newton, step),
        }
    }

    /// See [`Newton::refine`].
    pub fn refine(&mut self, program: &Program, point: &Point, step: &mut Point, correction: &mut Point) {
        match &mut self.paper {
            None => self.newton.refine(program, point, step, correction),
            Some(paper) => paper.refine(step),
        }
    }
}

impl Deref for NewtonSystem {
    type Target = Newton;

    fn deref(&self) -> &Newton {
        &self.newton
    }
}

impl DerefMut for NewtonSystem {
    fn deref_mut(&mut self) -> &mut Newton {
        &mut self.newton
    }
}

#[cfg(test)]
mod tests;
