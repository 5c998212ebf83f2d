"""Benches, one interface: serial, emulated firmware, digital twin, replay."""
