//! Named numbers and bits.

/// A number, or a bit, with a name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Named {
    /// Name, unique in its field; small letters, digits and underscores.
    pub name: &'static str,
    /// The field's number; for a bit its index from the field's lowest bit.
    pub number: u32,
    /// Meaning.
    pub meaning: &'static str,
}

/// Kind of content of a field.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Values {
    /// A number, or bits that the field's meaning explains.
    Plain,
    /// A code; each number has a name and meaning.
    Codes(&'static [Named]),
    /// Bits with a name and meaning each.
    Bits(&'static [Named]),
}

/// A number, or a bit, with a name.
pub(crate) const fn named(name: &'static str, number: u32, meaning: &'static str) -> Named {
    Named {
        name,
        number,
        meaning,
    }
}

/// Makes constants and a list from one row for each code: `CONSTANT = number, "name", "meaning";`.
macro_rules! codes {
    ($(#[$doc:meta])* $list:ident: $number:ty; $($constant:ident = $code:literal, $name:literal, $meaning:literal;)*) => {
        $(
            #[doc = concat!($meaning, ".")]
            pub const $constant: $number = $code;
        )*
        $(#[$doc])*
        pub const $list: &[$crate::Named] = &[$($crate::named::named($name, $code, $meaning)),*];
    };
}
pub(crate) use codes;
