//! The register map as CMSIS-SVD.
//!
//! The card is one peripheral at address 0, each block a cluster. Blocks that every channel has are arrays
//! (`result[%s]`), since svd2rust makes an indexed accessor of those. Single bits of a field have no element in SVD: they are listed
//! in its description. Start values that differ from channel to channel are left out by `resetMask`, as is RAM.

use super::{listed, with_unit, Map, MapBlock, MapRegister, ADDRESSES, UNLISTED, WORD_BYTES};
use endat_console::error::CommandError;
use endat_regs::{Access as TableAccess, Field as TableField};
use endat_regs::{Named, Values};
use svd_encoder::encode;
use svd_rs::{
    Access, AddressBlock, AddressBlockUsage, BitRange, BitRangeType, Cluster, ClusterInfo, Device,
    DimElement, EnumeratedValue, EnumeratedValues, Field, FieldInfo, Interrupt, Peripheral,
    PeripheralInfo, Register, RegisterCluster, RegisterInfo, RegisterProperties, SvdError,
    ValidateLevel,
};

/// A name or number that SVD does not allow is an error.
const LEVEL: ValidateLevel = ValidateLevel::Strict;
const WORD_BITS: u32 = 8 * WORD_BYTES;

/// The SVD file.
pub fn write(map: &Map) -> Result<String, CommandError> {
    let fault = |e: &dyn std::fmt::Display| {
        CommandError::input(format!(
            "SVD: {e}; this is a fault of this program, please report it"
        ))
    };
    let device = device(map).map_err(|e| fault(&e))?;
    let mut text = encode(&device).map_err(|e| fault(&e))?;
    text.push('\n');
    Ok(text)
}

fn device(map: &Map) -> Result<Device, SvdError> {
    let words = RegisterProperties::new()
        .size(Some(WORD_BITS))
        .access(Some(Access::ReadOnly))
        .reset_value(Some(0))
        .reset_mask(Some(u32::MAX.into()))
        .build(LEVEL)?;
    Device::builder()
        .name(map.name.clone())
        .version(map.version())
        .description(format!("{} {}", map.title(), map.origin))
        .address_unit_bits(8)
        .width(WORD_BITS)
        .default_register_properties(words)
        .peripherals(vec![peripheral(map)?])
        .build(LEVEL)
}

fn peripheral(map: &Map) -> Result<Peripheral, SvdError> {
    let size = map.blocks.iter().map(MapBlock::end_bytes).max();
    let address_block = AddressBlock::builder()
        .offset(0)
        .size(size.unwrap_or(0))
        .usage(AddressBlockUsage::Registers)
        .build(LEVEL)?;
    let clusters: Result<_, SvdError> = map
        .blocks
        .iter()
        .map(|block| cluster(block).map(RegisterCluster::Cluster))
        .collect();
    let has_interrupt = map
        .blocks
        .iter()
        .any(|block| block.block.name == "interrupt");
    let interrupt = Interrupt::builder()
        .name(map.name.clone())
        .description(Some(
            "irq_o; the number is that of your interrupt controller, 0 stands in for it".into(),
        ))
        .value(0)
        .build(LEVEL)?;
    let peripheral = PeripheralInfo::builder()
        .name(map.name.clone())
        .description(Some(format!("{ADDRESSES} {UNLISTED}")))
        .base_address(map.base_address.into())
        .address_block(Some(vec![address_block]))
        .interrupt(has_interrupt.then(|| vec![interrupt]))
        .registers(Some(clusters?))
        .build(LEVEL)?;
    Ok(Peripheral::Single(peripheral))
}

fn cluster(block: &MapBlock) -> Result<Cluster, SvdError> {
    let registers: Result<_, SvdError> = block
        .registers
        .iter()
        .map(|entry| register(entry).map(RegisterCluster::Register))
        .collect();
    let is_array = block.block.per_channel;
    let info = ClusterInfo::builder()
        .name(format!(
            "{}{}",
            block.block.name,
            if is_array { "[%s]" } else { "" }
        ))
        .description(Some(block.block.meaning.to_owned()))
        .address_offset(block.base_bytes())
        .children(registers?)
        .build(LEVEL)?;
    if !is_array {
        return Ok(Cluster::Single(info));
    }
    let dim = DimElement::builder()
        .dim(block.copies)
        .dim_increment(block.stride_bytes())
        .build(LEVEL)?;
    Ok(Cluster::Array(info, dim))
}

fn register(entry: &MapRegister) -> Result<Register, SvdError> {
    let register = entry.register;
    let access = match register.access {
        TableAccess::ReadOnly => Access::ReadOnly,
        TableAccess::ReadWrite => Access::ReadWrite,
        TableAccess::Strobe => Access::WriteOnly,
    };
    let word = RegisterProperties::new()
        .access(Some(access))
        .reset_value(Some(entry.reset().into()))
        .reset_mask(Some(entry.reset_mask().into()))
        .build(LEVEL)?;
    let fields: Result<_, SvdError> = register.fields.iter().map(|f| field(entry, f)).collect();
    let info = RegisterInfo::builder()
        .name(register.name.to_owned())
        .description(Some(register.meaning.to_owned()))
        .address_offset(u32::from(register.offset) * WORD_BYTES)
        .properties(word)
        .fields(Some(fields?))
        .build(LEVEL)?;
    Ok(Register::Single(info))
}

fn field(entry: &MapRegister, field: &TableField) -> Result<Field, SvdError> {
    let mut description = with_unit(field);
    let mut values = Vec::new();
    match field.values {
        Values::Plain => {}
        Values::Codes(codes) => values.push(enumerated(field.name, codes)?),
        Values::Bits(_) => description = format!("{description}: {}", listed(field.values)),
    }
    description += &entry.elsewhere(field);
    if let resets @ [_, _, ..] = &entry.field_resets(field)[..] {
        let resets: Vec<String> = resets.iter().map(u32::to_string).collect();
        description = format!("{description}; after reset {}", resets.join(", "));
    }
    let bits = BitRange {
        offset: field.lsb,
        width: field.width,
        range_type: BitRangeType::OffsetWidth,
    };
    let info = FieldInfo::builder()
        .name(field.name.to_owned())
        .description(Some(description))
        .bit_range(bits)
        .enumerated_values(values)
        .build(LEVEL)?;
    Ok(Field::Single(info))
}

fn enumerated(name: &str, codes: &[Named]) -> Result<EnumeratedValues, SvdError> {
    let values: Result<_, SvdError> = codes
        .iter()
        .map(|code| {
            EnumeratedValue::builder()
                .name(code.name.to_owned())
                .description(Some(code.meaning.to_owned()))
                .value(Some(code.number.into()))
                .build(LEVEL)
        })
        .collect();
    EnumeratedValues::builder()
        .name(Some(name.to_owned()))
        .values(values?)
        .build(LEVEL)
}
