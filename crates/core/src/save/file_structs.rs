//! Structs of files that stand beside structs of the core.

/// Declares a struct of the file and its translation from and to the core's struct, field by field.
/// A field the core gains or loses breaks the build here, where the decision belongs. Attributes of a field are those of
/// the struct of the file.
macro_rules! file_structs {
    ($($file:ident = $core:ident { $($(#[$attribute:meta])* $field:ident: $type:ty),* $(,)? })*) => {$(
        #[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
        #[serde(deny_unknown_fields)]
        pub struct $file { $($(#[$attribute])* pub $field: $type),* }

        impl From<$core> for $file {
            fn from($core { $($field),* }: $core) -> Self {
                Self { $($field: $field.into()),* }
            }
        }

        impl From<$file> for $core {
            fn from($file { $($field),* }: $file) -> Self {
                Self { $($field: $field.into()),* }
            }
        }
    )*};
}

pub(super) use file_structs;
