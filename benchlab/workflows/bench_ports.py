"""`benchlab bench ports`: the serial ports of this computer, and which of them may be a Nano."""

from __future__ import annotations

from typing import Any

from serial.tools import list_ports

USB_CHIPS = {
    (0x1A86, 0x7523): "CH340, as on most Nanos",
    (0x1A86, 0x5523): "CH341, as on some Nanos",
    (0x0403, 0x6001): "FT232, as on the original Nano",
    (0x0403, 0x6015): "FT231X",
    (0x2341, 0x0043): "Arduino Uno",
    (0x2341, 0x0058): "Arduino Nano Every: benchlab's firmware does not run on it",
    (0x10C4, 0xEA60): "CP2102",
}
"""USB vendor and product to what stands behind it."""


def serial_ports() -> list[dict[str, Any]]:
    """Each port: port, description, usb (`1a86:7523`, None for a port that is not USB), serial_number, chip (None where unknown)."""
    found = []
    for port in sorted(list_ports.comports()):
        known = port.vid is not None and port.pid is not None
        found.append(
            {
                "port": port.device,
                "description": port.description if port.description != "n/a" else None,
                "usb": f"{port.vid:04x}:{port.pid:04x}" if known else None,
                "serial_number": port.serial_number,
                "chip": USB_CHIPS.get((port.vid, port.pid)) if known else None,
            }
        )
    return found
