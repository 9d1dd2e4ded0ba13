use super::ReferenceCase;

/// A known fault.
pub struct Fault {
    /// What is wrong, for a person to read.
    pub name: &'static str,
    /// The check that has to notice, by its full name; others may too.
    pub aims_at: &'static str,
    /// Makes it wrong.
    pub inject: Box<dyn Fn(&mut ReferenceCase) + Send + Sync>,
}

/// Something that is nearly wrong.
pub struct NearMiss {
    /// What, for a person to read.
    pub name: &'static str,
    /// Brings it close.
    pub approach: Box<dyn Fn(&mut ReferenceCase) + Send + Sync>,
}

impl Fault {
    /// A fault that `aims_at` has to notice.
    pub fn new(
        aims_at: &'static str,
        name: &'static str,
        inject: impl Fn(&mut ReferenceCase) + Send + Sync + 'static,
    ) -> Self {
        Self { name, aims_at, inject: Box::new(inject) }
    }
}

impl NearMiss {
    /// Something that must pass.
    pub fn new(name: &'static str, approach: impl Fn(&mut ReferenceCase) + Send + Sync + 'static) -> Self {
        Self { name, approach: Box::new(approach) }
    }
}
