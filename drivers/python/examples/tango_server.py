"""A card as a device of Tango: positions, causes and name plates as attributes, the encoders' memory as a command.

Without a database of Tango:

    python tango_server.py lab -nodb -dlist lab/endat/1 -ORBendPoint giop:tcp:127.0.0.1:45450

and from another program, ``tango.DeviceProxy("tango://127.0.0.1:45450/lab/endat/1#dbase=no").position_0``. The port is the device's
property ``port``, or the environment's ``ENDAT_PORT``.
"""

import os
import time

import endat
from tango import Attribute, AttrQuality, DevState, WAttribute
from tango.server import Device, attribute, command, device_property


class EndatCard(Device):
    """A card and its encoders."""

    port = device_property(dtype=str, default_value=os.environ.get("ENDAT_PORT", "virtual"))

    def init_device(self) -> None:
        super().init_device()
        self._card: endat.Card | None = None
        try:
            self._card = endat.connect(self.port)
        except endat.EndatError as error:
            self.set_state(DevState.FAULT)
            self.set_status(str(error))
            return
        self.set_state(DevState.ON)
        for channel, reading in enumerate(self._card.read()):
            self.add_attribute(
                attribute(name=f"position_{channel}", dtype=float, unit=reading.unit, fget=self.position)
            )
            self.add_attribute(attribute(name=f"cause_{channel}", dtype=str, fget=self.cause))

    def delete_device(self) -> None:
        if self._card:
            self._card.close()
        super().delete_device()

    def _reading(self, attr: Attribute | WAttribute) -> endat.Reading:
        channel = int(attr.get_name().rsplit("_", 1)[1])
        return self._card.read()[channel]

    def position(self, attr: Attribute | WAttribute) -> tuple[float, float, AttrQuality]:
        """A position without a fresh result is reported as invalid."""
        reading = self._reading(attr)
        if reading.position is None:
            return 0.0, time.time(), AttrQuality.ATTR_INVALID
        quality = AttrQuality.ATTR_VALID if reading.fresh else AttrQuality.ATTR_INVALID
        return reading.position, time.time(), quality

    def cause(self, attr: Attribute | WAttribute) -> str:
        return self._reading(attr).cause

    @attribute(dtype=(str,), max_dim_x=8, doc="ID and serial number of each encoder, if the card reads them")
    def encoders(self) -> list[str]:
        return [f"{plate.id} {plate.serial}" if plate else "" for plate in self._card.encoders()]

    @command(dtype_in=(int,), doc_in="channel, MRS code, address", dtype_out=int, doc_out="the word")
    def read_parameter(self, asked: list[int]) -> int:
        channel, area, address = (int(n) for n in asked)
        return self._card.read_parameter(channel, area, address)


if __name__ == "__main__":
    EndatCard.run_server()
