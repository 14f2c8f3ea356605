//! Numbers and bits that stand for something.

/// A number, or a bit, with a name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Named {
    /// Name, unique in its field; small letters, digits and underscores.
    pub name: &'static str,
    /// The field's number; of a bit its place, counted from the field's lowest bit.
    pub number: u32,
    /// What it stands for.
    pub meaning: &'static str,
}

/// How the content of a field is to be read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Values {
    /// As a number, or as bits that the field's meaning explains.
    Plain,
    /// Each of these numbers has a meaning of its own.
    Codes(&'static [Named]),
    /// Each of these bits has a meaning of its own.
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

/// Codes as constants and as a list, from one row for each: `CONSTANT = number, "name", "meaning";`.
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
