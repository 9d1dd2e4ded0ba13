use super::ReferenceCase;

/// A known fault.
pub struct Fault {
    /// Description.
    pub name: &'static str,
    /// The target check, which has to fail, by its full name; others may fail as well.
    pub aims_at: &'static str,
    /// Injects the fault.
    pub inject: Box<dyn Fn(&mut ReferenceCase) + Send + Sync>,
}

/// A plan or flight just inside a limit.
pub struct NearMiss {
    /// Description.
    pub name: &'static str,
    /// Changes the reference case.
    pub approach: Box<dyn Fn(&mut ReferenceCase) + Send + Sync>,
}

impl Fault {
    /// A fault for which the check `aims_at` has to fail.
    pub fn new(
        aims_at: &'static str,
        name: &'static str,
        inject: impl Fn(&mut ReferenceCase) + Send + Sync + 'static,
    ) -> Self {
        Self { name, aims_at, inject: Box::new(inject) }
    }
}

impl NearMiss {
    /// A near miss, which must pass.
    pub fn new(name: &'static str, approach: impl Fn(&mut ReferenceCase) + Send + Sync + 'static) -> Self {
        Self { name, approach: Box::new(approach) }
    }
}
