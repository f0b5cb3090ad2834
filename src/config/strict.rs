//! JSON values for serde, but for one thing: an array is no object.
//!
//! serde takes an array for a struct and fills its fields in order. In a config the keys would then go unsaid, and a list with one
//! value too few would mean something; here it is refused. Nothing of a config is handed to serde_json's own reading, or every type
//! in it would be compiled for that one too.

use serde::de::value::StrDeserializer;
use serde::de::{
    Deserialize, DeserializeSeed, Deserializer, EnumAccess, Error as _, IgnoredAny, IntoDeserializer, MapAccess,
    SeqAccess, Unexpected, VariantAccess, Visitor,
};
use serde::forward_to_deserialize_any;
use serde_json::{Error, Value};

/// A value, to be read strictly with all that is in it.
#[derive(Clone, Copy)]
pub(super) struct Strict<'a>(pub(super) &'a Value);

impl<'de> Deserializer<'de> for Strict<'de> {
    type Error = Error;

    fn deserialize_any<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        match self.0 {
            Value::Array(values) => {
                let mut rest = values.iter();
                let value = visitor.visit_seq(Values { rest: &mut rest })?;
                match rest.len() {
                    0 => Ok(value),
                    _ => Err(Error::invalid_length(values.len(), &"fewer elements in array")),
                }
            }
            Value::Object(members) => {
                // the key that says what kind of object it is comes first, wherever it stands
                let mut all: Vec<_> = members.iter().collect();
                all.sort_by_key(|(key, _)| key.as_str() != "default");
                visitor.visit_map(Members { rest: all.into_iter(), value: None })
            }
            Value::Null => visitor.visit_unit(),
            Value::Bool(single) => visitor.visit_bool(*single),
            Value::Number(single) => single.deserialize_any(visitor),
            Value::String(single) => visitor.visit_borrowed_str(single),
        }
    }

    fn deserialize_struct<V: Visitor<'de>>(
        self,
        _: &'static str,
        _: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Error> {
        match self.0 {
            Value::Array(_) => Err(Error::invalid_type(Unexpected::Seq, &visitor)),
            _ => self.deserialize_any(visitor),
        }
    }

    fn deserialize_option<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        match self.0 {
            Value::Null => visitor.visit_none(),
            _ => visitor.visit_some(self),
        }
    }

    fn deserialize_newtype_struct<V: Visitor<'de>>(self, _: &'static str, visitor: V) -> Result<V::Value, Error> {
        visitor.visit_newtype_struct(self)
    }

    fn deserialize_enum<V: Visitor<'de>>(
        self,
        name: &'static str,
        variants: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Error> {
        match self.0 {
            Value::Object(members) if members.len() == 1 => {
                let (kind, value) = members.iter().next().ok_or_else(|| Error::custom("an empty object"))?;
                visitor.visit_enum(Variant { kind, content: Content(Some(value)) })
            }
            Value::String(kind) => visitor.visit_enum(Variant { kind, content: Content(None) }),
            // what is no variant: serde_json's own words do
            other => other.deserialize_enum(name, variants, IgnoredAny).and_then(|_| Err(Error::custom("no variant"))),
        }
    }

    forward_to_deserialize_any! {
        bool i8 i16 i32 i64 i128 u8 u16 u32 u64 u128 f32 f64 char str string bytes byte_buf unit unit_struct seq tuple
        tuple_struct map identifier ignored_any
    }
}

struct Values<'a, 'b> {
    rest: &'b mut std::slice::Iter<'a, Value>,
}

impl<'de> SeqAccess<'de> for Values<'de, '_> {
    type Error = Error;

    fn next_element_seed<T: DeserializeSeed<'de>>(&mut self, seed: T) -> Result<Option<T::Value>, Error> {
        self.rest.next().map(|value| seed.deserialize(Strict(value))).transpose()
    }

    fn size_hint(&self) -> Option<usize> {
        Some(self.rest.len())
    }
}

struct Members<'a> {
    rest: std::vec::IntoIter<(&'a String, &'a Value)>,
    value: Option<&'a Value>,
}

impl<'de> MapAccess<'de> for Members<'de> {
    type Error = Error;

    fn next_key_seed<K: DeserializeSeed<'de>>(&mut self, seed: K) -> Result<Option<K::Value>, Error> {
        let Some((key, value)) = self.rest.next() else { return Ok(None) };
        self.value = Some(value);
        let key: StrDeserializer<Error> = key.as_str().into_deserializer();
        seed.deserialize(key).map(Some)
    }

    fn next_value_seed<V: DeserializeSeed<'de>>(&mut self, seed: V) -> Result<V::Value, Error> {
        let value = self.value.take().ok_or_else(|| Error::custom("a value without its key"))?;
        seed.deserialize(Strict(value))
    }
}

struct Variant<'a> {
    kind: &'a str,
    content: Content<'a>,
}

/// What a variant is of; a name alone has nothing.
struct Content<'a>(Option<&'a Value>);

impl<'a> Content<'a> {
    fn of(self, variant: &'static str) -> Result<Strict<'a>, Error> {
        self.0.map(Strict).ok_or_else(|| Error::invalid_type(Unexpected::UnitVariant, &variant))
    }
}

impl<'de> EnumAccess<'de> for Variant<'de> {
    type Error = Error;
    type Variant = Content<'de>;

    fn variant_seed<V: DeserializeSeed<'de>>(self, seed: V) -> Result<(V::Value, Content<'de>), Error> {
        let kind: StrDeserializer<Error> = self.kind.into_deserializer();
        Ok((seed.deserialize(kind)?, self.content))
    }
}

impl<'de> VariantAccess<'de> for Content<'de> {
    type Error = Error;

    fn unit_variant(self) -> Result<(), Error> {
        self.0.map_or(Ok(()), |value| Deserialize::deserialize(Strict(value)))
    }

    fn newtype_variant_seed<T: DeserializeSeed<'de>>(self, seed: T) -> Result<T::Value, Error> {
        seed.deserialize(self.of("newtype variant")?)
    }

    fn tuple_variant<V: Visitor<'de>>(self, _: usize, visitor: V) -> Result<V::Value, Error> {
        self.of("tuple variant")?.deserialize_any(visitor)
    }

    fn struct_variant<V: Visitor<'de>>(self, fields: &'static [&'static str], visitor: V) -> Result<V::Value, Error> {
        self.of("struct variant")?.deserialize_struct("", fields, visitor)
    }
}
