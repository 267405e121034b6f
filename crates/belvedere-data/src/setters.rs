//! `with_…` methods for structs of parameters, which are `#[non_exhaustive]` so that they can gain fields without
//! breaking programs.

/// One method for each field named; of an optional field it takes the value.
#[doc(hidden)]
#[macro_export]
macro_rules! setters {
    ($type:ty { $($method:ident($field:ident: $of:ty),)+ }) => {
        impl $type {
            $(
                #[doc = concat!("The same with another [`", stringify!($field), "`](Self#structfield.", stringify!($field), ").")]
                #[must_use]
                pub fn $method(mut self, $field: $of) -> Self {
                    self.$field = $field.into();
                    self
                }
            )+
        }
    };
}
