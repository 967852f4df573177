//! Early returns with a text.

/// Returns [`Error::Invalid`](super::Error::Invalid) with a text, written as for `format!`.
macro_rules! bail {
    ($($text:tt)+) => {
        return Err($crate::error::Error::Invalid(format!($($text)+)))
    };
}

/// Returns [`Error::Invalid`](super::Error::Invalid) with a text unless a condition holds.
macro_rules! ensure {
    ($condition:expr, $($text:tt)+) => {
        let holds: bool = $condition;
        if !holds {
            $crate::error::bail!($($text)+);
        }
    };
}

/// Returns [`Error::Option`](super::Error::Option) with a text unless a condition holds.
macro_rules! ensure_option {
    ($condition:expr, $($text:tt)+) => {
        let holds: bool = $condition;
        if !holds {
            return Err($crate::error::Error::Option(format!($($text)+)));
        }
    };
}

/// Returns [`Error::Output`](super::Error::Output) with a text.
macro_rules! bail_output {
    ($($text:tt)+) => {
        return Err($crate::error::Error::Output(format!($($text)+)))
    };
}

pub(crate) use {bail, bail_output, ensure, ensure_option};
