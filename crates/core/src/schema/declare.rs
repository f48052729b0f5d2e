//! Macros that declare settings: the documentation, the default and the row of a setting stand in one place.

/// Declares a struct of settings in the order in which files have them, with their defaults.
///
/// If each default is followed by a row, the struct is a [`SettingGroup`](super::SettingGroup) whose walk has the order of the fields.
/// `in "title": "about"` makes a section of the group; other methods of `SettingGroup` may follow the fields.
///
/// ```text
/// setting_group! {
///     /// The size of a door.
///     pub struct Size in "Door": "How large the door is." {
///         /// Width, in metres.
///         width_m: f32 = 1.0,
///             number("Width", 0.5..=4.0).unit("m").hint("Narrow ones keep the wind out");
///     }
/// }
/// ```
macro_rules! setting_group {
    (
        $(#[$meta:meta])*
        pub struct $group:ident {
            $($(#[$field_meta:meta])* $field:ident: $type:ty = $default:expr;)*
        }
    ) => {
        $(#[$meta])*
        #[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
        #[serde(deny_unknown_fields)]
        pub struct $group { $($(#[$field_meta])* pub $field: $type,)* }

        impl Default for $group {
            fn default() -> Self {
                Self { $($field: $default),* }
            }
        }
    };
    (
        $(#[$meta:meta])*
        pub struct $group:ident $(in $title:literal: $about:literal)? {
            $($(#[$field_meta:meta])* $field:ident: $type:ty = $default:expr, $row:expr;)*
        }
        $($method:tt)*
    ) => {
        $crate::schema::setting_group! {
            $(#[$meta])*
            pub struct $group { $($(#[$field_meta])* $field: $type = $default;)* }
        }

        $(impl $group {
            /// Section of these settings.
            pub const SECTION: $crate::schema::Section =
                $crate::schema::Section { title: $title, about: $about };
        })?

        impl $crate::schema::SettingGroup for $group {
            fn walk(&mut self, walk: &mut $crate::schema::Walk<'_>) {
                let Self { $($field),* } = self;
                $(walk.section($crate::schema::Section { title: $title, about: $about });)?
                $crate::schema::settings! { walk, $($field: $row;)* }
            }

            $($method)*
        }
    };
}

/// Visits fields of a group under their rows, with the fields' names: `settings! { walk, width_m: number(..); }`.
macro_rules! settings {
    ($walk:ident, $($field:ident: $row:expr;)*) => {
        $($walk.setting(stringify!($field), $row, $field);)*
    };
}

/// Declares an enum whose values have names, titles and sentences, with [`Choices`](super::Choices) in the order of the values:
/// `pub enum Tyre { Soft = "soft", "Soft", "It gives way."; }`. The sentence is also the documentation of the value.
#[macro_export]
macro_rules! choices {
    (
        $(#[$meta:meta])*
        pub enum $choices:ident {
            $($(#[$more:meta])* $value:ident = $name:literal, $title:literal, $sentence:literal;)*
        }
    ) => {
        $(#[$meta])*
        #[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
        pub enum $choices {
            $(
                #[doc = $sentence]
                $(#[$more])*
                #[serde(rename = $name)]
                $value,
            )*
        }

        impl $crate::schema::Choices for $choices {
            const OPTIONS: &'static [Self] = &[$(Self::$value),*];

            fn choice(self) -> $crate::schema::Choice {
                match self {
                    $(Self::$value => $crate::schema::Choice::new($name, $title, $sentence),)*
                }
            }
        }
    };
}

/// Declares an enum with the list `ALL` of its values: `pub enum Side { Left; Right; }`.
#[macro_export]
macro_rules! listed_values {
    (
        $(#[$meta:meta])*
        pub enum $listed:ident {
            $($(#[$more:meta])* $value:ident;)*
        }
    ) => {
        $(#[$meta])*
        #[derive(Debug, Clone, Copy, PartialEq, Eq)]
        pub enum $listed { $($(#[$more])* $value,)* }

        impl $listed {
            /// All values, in the order of their declaration.
            pub const ALL: [Self; [$(stringify!($value)),*].len()] = [$(Self::$value),*];
        }
    };
}

/// Declares an enum with a list `ALL` and a `name` for each value: `pub enum Side { Left = "left side"; }`.
#[macro_export]
macro_rules! named_values {
    (
        $(#[$meta:meta])*
        pub enum $named:ident {
            $($(#[$more:meta])* $value:ident = $name:literal;)*
        }
    ) => {
        $crate::schema::listed_values! {
            $(#[$meta])*
            pub enum $named {
                $(
                    #[doc = concat!("*", $name, "*.")]
                    $(#[$more])*
                    $value;
                )*
            }
        }

        impl $named {
            /// Returns the name of the value.
            pub fn name(self) -> &'static str {
                match self { $(Self::$value => $name,)* }
            }
        }
    };
}

/// Implements the names of a type whose method `info()` returns a row of facts with a name, a title and a description: as methods, as the
/// displayed text, and as [`Choices`](super::Choices) in the order of `ALL`.
macro_rules! named_by_info {
    ($kind:ident) => {
        impl $kind {
            /// Returns the name in files; flags may write - for _.
            pub fn name(self) -> &'static str {
                self.info().name
            }

            /// Returns the name at the head of a list or a chart.
            pub fn title(self) -> &'static str {
                self.info().title
            }

            /// Returns a sentence that describes the value.
            pub fn words(self) -> &'static str {
                self.info().words
            }
        }

        impl std::fmt::Display for $kind {
            fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                formatter.write_str(self.name())
            }
        }

        impl $crate::schema::Choices for $kind {
            const OPTIONS: &'static [Self] = &Self::ALL;

            fn choice(self) -> $crate::schema::Choice {
                $crate::schema::Choice::new(self.name(), self.title(), self.words())
            }
        }
    };
}

pub(crate) use {named_by_info, setting_group, settings};
