"""Prints what a register map says, one fact a line: as SVD read by cmsis-svd, as RDL read by systemrdl-compiler."""

import sys


def show(block, index, name, address, access, fields):
    where = f"{block}[{index}].{name}" if index is not None else f"{block}.{name}"
    print(f"{where} 0x{address:04X} {access}")
    for field, msb, lsb, access, reset, codes in fields:
        reset = "-" if reset is None else reset
        print(f"{where}.{field} {msb}:{lsb} {access} reset {reset}")
        for code, text, meaning in codes:
            print(f"{where}.{field} = {code} {text}: {meaning}")


def read_svd(path):
    from cmsis_svd.parser import SVDParser

    access_names = {"READ_ONLY": "ro", "READ_WRITE": "rw", "WRITE_ONLY": "strobe"}
    device = SVDParser.for_xml_file(path).get_device()
    for register in device.peripherals[0].get_registers():
        cluster = register.parent.name
        name = register.name.removeprefix(cluster + "_")
        block, _, index = cluster.rstrip("]").partition("[")
        fields = []
        for field in register.fields:
            mask = (1 << field.bit_width) - 1
            known = (register.reset_mask >> field.bit_offset) & mask == mask
            lists = field.enumerated_values or []
            fields.append((
                field.name,
                field.bit_offset + field.bit_width - 1,
                field.bit_offset,
                access_names[field.access.name],
                (register.reset_value >> field.bit_offset) & mask if known else None,
                [(v.value, v.name, v.description) for one in lists for v in one.enumerated_values],
            ))
        show(block, index or None, name, register.address_offset, access_names[register.access.name], fields)


def read_rdl(path):
    from systemrdl import RDLCompiler

    access_names = {"r": "ro", "rw": "rw", "w": "strobe"}
    compiler = RDLCompiler()
    compiler.compile_file(path)
    for block in compiler.elaborate().top.children(unroll=True):
        index = block.current_idx[0] if block.current_idx else None
        for register in block.registers():
            fields = []
            for field in register.fields():
                codes = field.get_property("encode") or []
                fields.append((
                    field.inst_name,
                    field.msb,
                    field.lsb,
                    access_names[field.get_property("sw").name],
                    field.get_property("reset"),
                    [(c.value, c.name, c.rdl_desc) for c in codes],
                ))
            # A register of SystemRDL has no access of its own.
            (access,) = {field[3] for field in fields}
            show(block.inst_name, index, register.inst_name, register.absolute_address, access, fields)


{"svd": read_svd, "rdl": read_rdl}[sys.argv[1].rpartition(".")[2]](sys.argv[1])
