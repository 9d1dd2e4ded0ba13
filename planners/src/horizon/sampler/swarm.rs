//! Particle swarm optimisation with feasibility rules (eq. 13 to 15).

use super::{Frame, Sampler};
use crate::horizon::draw::Draws;
use crate::horizon::group::{Fitness, Group, Quad};
use crate::lanes::WIDTH;

/// Rules of the swarm.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Swarm {
    /// c_1: attraction by the particle's own best.
    pub cognitive: f64,
    /// c_2: attraction by the best of all.
    pub social: f64,
    /// w of eq. 14 for all particles, or by eq. 15 for infeasible ones.
    pub inertia: Inertia,
    /// Bound on a particle's velocity over the bound of its controls.
    pub velocity_share: f64,
    /// The position moves by w v, as the paper prints eq. 13; otherwise by v.
    pub moves_as_printed: bool,
}

/// w(k) = w_max - (w_max - w_min) k/k_max (eq. 14).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Inertia {
    /// w_max.
    pub first: f64,
    /// w_min.
    pub last: f64,
    /// Infeasible particles have w_max = 1 - F/max F with their violation F (eq. 15), w_min at least: the worse, the more
    /// a particle listens to the others. Eq. 14 is then applied to this w_max.
    pub by_violation: bool,
}

impl Swarm {
    /// The swarm of eq. 13 and 14.
    pub const USUAL: Self = Self {
        cognitive: 1.5,
        social: 1.5,
        inertia: Inertia { first: 0.9, last: 0.4, by_violation: false },
        velocity_share: 0.5,
        moves_as_printed: false,
    };

    /// The same with eq. 15.
    pub const FEASIBILITY: Self =
        Self { inertia: Inertia { by_violation: true, ..Self::USUAL.inertia }, ..Self::USUAL };
}

impl Inertia {
    fn at(&self, progress: f64, violation: f64, worst_violation: f64) -> f64 {
        let first = if self.by_violation && violation > 0.0 {
            (1.0 - violation / worst_violation).max(self.last)
        } else {
            self.first
        };
        first - (first - self.last) * progress
    }
}

/// The swarm.
#[derive(Clone, Debug)]
pub struct Flock {
    frame: Frame,
    rules: Swarm,
    /// Four particles each.
    members: Vec<Member>,
    best: Vec<f64>,
    best_fitness: Fitness,
    worst_violation: f64,
}

/// Four particles between the iterations.
#[derive(Clone, Debug)]
struct Member {
    /// v of eq. 13.
    velocity: Vec<Quad>,
    /// P_i.
    best: Vec<Quad>,
    best_fitness: [Fitness; WIDTH],
    violation: Quad,
}

impl Flock {
    /// Particles anywhere within the bounds, once they have been proposed.
    pub fn new(frame: Frame, rules: Swarm) -> Self {
        let unknowns = frame.grid.unknowns();
        let zero = vec![[0.0; WIDTH]; unknowns];
        let member = Member {
            velocity: zero.clone(),
            best: zero,
            best_fitness: [Fitness::WORST; WIDTH],
            violation: [0.0; WIDTH],
        };
        Self {
            frame,
            rules,
            members: vec![member; frame.particles / WIDTH],
            best: vec![0.0; unknowns],
            best_fitness: Fitness::WORST,
            worst_violation: 0.0,
        }
    }

    fn scatter(&self, draws: Draws, groups: &mut [Group]) {
        for (g, group) in groups.iter_mut().enumerate() {
            for (unknown, quad) in group.controls.iter_mut().enumerate() {
                for (lane, control) in quad.iter_mut().enumerate() {
                    let [share, _] = draws.uniform_pair(self.frame.place(0, g * WIDTH + lane, unknown));
                    *control = (2.0 * share - 1.0) * self.frame.bound_mps2;
                }
            }
        }
    }

    fn inertias(&self, iteration: usize, member: usize) -> Quad {
        let progress = iteration as f64 / self.frame.iterations as f64;
        self.members[member].violation.map(|violation| self.rules.inertia.at(progress, violation, self.worst_violation))
    }
}

impl Sampler for Flock {
    fn propose(&mut self, iteration: usize, draws: Draws, groups: &mut [Group]) {
        if iteration == 0 {
            return self.scatter(draws, groups);
        }
        let (bound, fastest) = (self.frame.bound_mps2, self.rules.velocity_share * self.frame.bound_mps2);
        for (g, group) in groups.iter_mut().enumerate() {
            let inertia = self.inertias(iteration, g);
            let stride = if self.rules.moves_as_printed { inertia } else { [1.0; WIDTH] };
            let member = &mut self.members[g];
            for (unknown, quad) in group.controls.iter_mut().enumerate() {
                let (own, all) = (member.best[unknown], self.best[unknown]);
                let velocity = &mut member.velocity[unknown];
                for lane in 0..WIDTH {
                    let [r1, r2] = draws.uniform_pair(self.frame.place(iteration, g * WIDTH + lane, unknown));
                    let at = quad[lane];
                    // v <- w v + c1 r1 (P - u) + c2 r2 (G - u), u <- u + v (eq. 13)
                    let pull = self.rules.cognitive * r1 * (own[lane] - at) + self.rules.social * r2 * (all - at);
                    velocity[lane] = (inertia[lane] * velocity[lane] + pull).clamp(-fastest, fastest);
                    quad[lane] = (at + stride[lane] * velocity[lane]).clamp(-bound, bound);
                }
            }
        }
    }

    fn learn(&mut self, groups: &[Group]) {
        self.worst_violation = 0.0;
        for (member, group) in self.members.iter_mut().zip(groups) {
            for lane in 0..WIDTH {
                let fitness = group.fitness[lane];
                member.violation[lane] = fitness.violation;
                self.worst_violation = self.worst_violation.max(fitness.violation);
                if !fitness.beats(member.best_fitness[lane]) {
                    continue;
                }
                member.best_fitness[lane] = fitness;
                for (best, quad) in member.best.iter_mut().zip(&group.controls) {
                    best[lane] = quad[lane];
                }
                if fitness.beats(self.best_fitness) {
                    self.best_fitness = fitness;
                    self.best = group.particle(lane);
                }
            }
        }
    }
}
