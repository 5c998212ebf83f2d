"""The simulated bench as a device."""
