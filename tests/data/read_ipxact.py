"""Prints the registers of an IP-XACT component with their byte addresses, one a line."""

import sys
import xml.etree.ElementTree as xml

SPACE = "{http://www.accellera.org/XMLSchema/IPXACT/1685-2014}"


def number(node, tag, usual="0"):
    return int(node.findtext(SPACE + tag, usual).replace("'h", "0x"), 0)


def walk(node, path, base):
    for register in node.findall(SPACE + "register"):
        address = base + number(register, "addressOffset")
        print(f"{path}{register.findtext(SPACE + 'name')} 0x{address:04X}")
    for file in node.findall(SPACE + "registerFile"):
        name = file.findtext(SPACE + "name")
        offset, dim = base + number(file, "addressOffset"), file.findtext(SPACE + "dim")
        for index in range(int(dim or 1)):
            where = f"{name}[{index}]." if dim else f"{name}."
            walk(file, path + where, offset + index * number(file, "range"))


for block in xml.parse(sys.argv[1]).getroot().iter(SPACE + "addressBlock"):
    walk(block, "", number(block, "baseAddress"))
