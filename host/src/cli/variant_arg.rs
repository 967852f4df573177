//! The arm tracker's variants as values of an option: names and help from the core's table.

use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use sinew_core::tracker::arm::Variant;

/// Reads a variant by its name, or by that of older versions.
pub fn variant_parser() -> impl TypedValueParser<Value = Variant> {
    let values = Variant::ALL.map(|variant| {
        let traits = variant.traits();
        PossibleValue::new(traits.name).help(traits.summary).aliases(traits.alias)
    });
    PossibleValuesParser::new(values).try_map(|name| Variant::from_name(&name).ok_or("there is no such variant"))
}
