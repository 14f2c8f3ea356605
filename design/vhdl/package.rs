//! The package that goes along with the entities.

use super::text::comment;
use crate::elaborate::Design;
use crate::printing::Names;

/// Its name.
pub fn package_name(design: &Design) -> String {
    let modules = design.modules.iter().map(|m| &m.name);
    Names::new(modules).unique(&format!("{}_logic", design.top().name))
}

/// Names of its functions, and of others that the text calls.
pub(super) const FUNCTIONS: [&str; 16] = [
    "to_sl",
    "resize",
    "slice",
    "bit_at",
    "and_reduce",
    "xor_reduce",
    "places",
    "to_integer",
    "to_unsigned",
    "shift_left",
    "shift_right",
    "rising_edge",
    "falling_edge",
    "unsigned",
    "std_logic",
    "std_logic_vector",
];

/// Its text.
pub(super) fn text(design: &Design) -> String {
    let name = package_name(design);
    let docs = ["Functions for constructs that VHDL-93 lacks.".to_string()];
    let head = comment(&docs, "");
    let text = TEXT.replace("NAME", &name);
    format!(
        "library ieee;\nuse ieee.std_logic_1164.all;\nuse ieee.numeric_std.all;\n\n{head}{text}"
    )
}

const TEXT: &str = "package NAME is
    -- A condition as a bit.
    function to_sl (condition : boolean) return std_logic;

    -- A bit as a number of so many bits, and as an index.
    function resize (value : std_logic; width : natural) return unsigned;
    function to_integer (value : std_logic) return natural;

    -- Bits of an expression.
    function slice (value : unsigned; high : natural; low : natural) return unsigned;

    -- A bit of an expression, '0' beyond its end.
    function bit_at (value : unsigned; index : natural) return std_logic;

    -- All bits are '1'; an odd number of bits is '1'.
    function and_reduce (value : unsigned) return std_logic;
    function xor_reduce (value : unsigned) return std_logic;

    -- How far to shift, by a number that may be larger than an integer: nothing is as wide as what this ends at.
    function places (value : unsigned) return natural;
end package;

package body NAME is
    function to_sl (condition : boolean) return std_logic is
    begin
        if condition then
            return '1';
        end if;
        return '0';
    end function;

    function resize (value : std_logic; width : natural) return unsigned is
        variable result : unsigned(width - 1 downto 0);
    begin
        result := (others => '0');
        result(0) := value;
        return result;
    end function;

    function to_integer (value : std_logic) return natural is
    begin
        if value = '1' then
            return 1;
        end if;
        return 0;
    end function;

    function slice (value : unsigned; high : natural; low : natural) return unsigned is
        alias bits : unsigned(value'length - 1 downto 0) is value;
    begin
        return bits(high downto low);
    end function;

    function bit_at (value : unsigned; index : natural) return std_logic is
        alias bits : unsigned(value'length - 1 downto 0) is value;
    begin
        if index >= value'length then
            return '0';
        end if;
        return bits(index);
    end function;

    function and_reduce (value : unsigned) return std_logic is
        variable result : std_logic;
    begin
        result := '1';
        for index in value'range loop
            result := result and value(index);
        end loop;
        return result;
    end function;

    function xor_reduce (value : unsigned) return std_logic is
        variable result : std_logic;
    begin
        result := '0';
        for index in value'range loop
            result := result xor value(index);
        end loop;
        return result;
    end function;

    function places (value : unsigned) return natural is
        alias bits : unsigned(value'length - 1 downto 0) is value;
    begin
        for index in bits'range loop
            if index > 9 and bits(index) = '1' then
                return 1023;
            end if;
        end loop;
        return to_integer(resize(bits, 10));
    end function;
end package body;
";
