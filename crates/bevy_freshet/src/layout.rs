//! Compares what Rust writes for a shader with what its WGSL reads.
use bevy::{
    prelude::*,
    reflect::Typed,
    render::render_resource::{ShaderType, encase::private::StructMetadata},
};
use naga::{ScalarKind, TypeInner, front::wgsl::parse_str};

/// Name, offset in bytes and kind of number of a member.
type Member = (String, u64, ScalarKind);

/// Panics unless `T` and the structure `name` of `wgsl` have the same members at the same offsets, and the same size.
pub(crate) fn assert_same_layout<T, const N: usize>(wgsl: &str, name: &str)
where
    T: ShaderType<ExtraMetadata = StructMetadata<N>> + Typed,
{
    let (read, size) = members_read(wgsl, name);
    let written = members_written::<T, N>();
    for (written, read) in written.iter().zip(&read) {
        assert_eq!(written, read, "Rust writes the left, WGSL reads the right");
    }
    assert_eq!(written.len(), read.len(), "number of members");
    assert_eq!(T::min_size().get(), size, "size in bytes");
}

fn members_written<T, const N: usize>() -> Vec<Member>
where
    T: ShaderType<ExtraMetadata = StructMetadata<N>> + Typed,
{
    let fields = T::type_info().as_struct().expect("a struct is asked for");
    let kind = |path: &str| match path {
        path if path.contains("u32") || path.contains("UVec") => ScalarKind::Uint,
        path if path.contains("i32") || path.contains("IVec") => ScalarKind::Sint,
        _ => ScalarKind::Float,
    };
    fields
        .iter()
        .zip(T::METADATA.extra.offsets)
        .map(|(field, offset)| (field.name().into(), offset, kind(field.type_path())))
        .collect()
}

/// The members of a structure as naga lays them out, and its size in bytes.
fn members_read(wgsl: &str, name: &str) -> (Vec<Member>, u64) {
    // The rest of the file is not plain WGSL before its imports are resolved.
    let from = wgsl.find(&format!("struct {name} {{")).expect("the structure is in the file");
    let to = from + wgsl[from..].find('}').expect("the structure ends");
    let module = parse_str(&wgsl[from..=to]).expect("the structure is plain WGSL");
    let kind = |inner: &TypeInner| match *inner {
        TypeInner::Array { base, .. } => module.types[base].inner.scalar_kind(),
        _ => inner.scalar_kind(),
    };
    let types = module.types.iter().find(|(_, ty)| ty.name.as_deref() == Some(name));
    let Some(TypeInner::Struct { members, span }) = types.map(|(_, ty)| &ty.inner) else {
        panic!("{name} is a structure")
    };
    let member = |member: &naga::StructMember| {
        let kind = kind(&module.types[member.ty].inner).expect("members are made of numbers");
        (member.name.clone().expect("members have names"), u64::from(member.offset), kind)
    };
    (members.iter().map(member).collect(), u64::from(*span))
}
