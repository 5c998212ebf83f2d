"""How the sketch frees its bus from a DAC that was left anywhere in a byte: compiled for this computer, with a model of bus and DAC."""

import re
import shutil
import subprocess
from importlib.resources import files
from pathlib import Path

import pytest

pytestmark = pytest.mark.skipif(shutil.which("cc") is None, reason="no C compiler here")

MODEL = """
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#define PC4 4
#define PC5 5
#define F_CPU 16000000UL
#define TWI_HZ 100000UL
#define TWEN 2
static uint8_t PORTC, TWSR, TWBR;
static uint8_t ddr, twcr = 1 << TWEN, master_sda;   /* what the stuck TWI unit gives while it has the pins; its SCL is low */
/* the DAC: receiver (0), acknowledging (1), sender (2), or off the bus (3) */
static int state, bits, byte, took, latched, sends;
static int slave_low, scl = 0, sda = 1;

static void settle(void)
{
    int own = twcr & (1 << TWEN);
    int new_scl = own ? 0 : !(ddr & (1 << PC5));
    int new_sda = (own ? master_sda : !(ddr & (1 << PC4))) && !slave_low;
    if (new_scl && scl && new_sda != sda) {          /* start or stop: whatever was under way has ended */
        state = 3;
        slave_low = 0;
        new_sda = own ? master_sda : !(ddr & (1 << PC4));
    } else if (new_scl && !scl) {                    /* rise: a bit is read */
        if (state == 0) {
            byte = byte << 1 | new_sda;
            bits++;
        } else if (state == 2)
            bits++;
    } else if (!new_scl && scl) {                    /* fall: the next bit is given, or what was acknowledged is taken */
        if (state == 1) {
            latched = byte & 255;
            took = 1;
            state = 0;
            bits = byte = slave_low = 0;
        } else if (state == 0 && bits == 8) {
            state = 1;
            slave_low = 1;
        } else if (state == 2) {
            if (bits == 8)
                slave_low = 0;
            else if (bits == 9)
                state = new_sda ? 3 : 2, bits = 0;
            if (bits < 8 && state == 2)
                slave_low = !(sends >> (7 - bits) & 1);
        }
    }
    scl = new_scl;
    sda = (own ? master_sda : !(ddr & (1 << PC4))) && !slave_low;
}
static void _delay_us(int us) { (void)us; settle(); }
static uint8_t pins(void) { settle(); return sda << PC4 | scl << PC5; }
#define DDRC ddr
#define PINC pins()
#define TWCR twcr
%s
int main(int argc, char **argv)
{
    (void)argc;
    state = atoi(argv[1]); bits = atoi(argv[2]); byte = atoi(argv[3]); sends = atoi(argv[4]); master_sda = atoi(argv[5]);
    if (state == 1) slave_low = 1;
    if (state == 2) slave_low = !(sends >> (7 - bits) & 1);
    settle();
    twi_begin();
    int free = !slave_low;
    printf("%%d %%d %%d %%d\\n", took, latched, state, free);
}
"""


@pytest.fixture(scope="module")
def bus(tmp_path_factory: pytest.TempPathFactory) -> Path:
    sketch = (files("benchlab") / "firmware" / "benchlab_nano" / "benchlab_nano.ino").read_text(encoding="utf-8")
    found = re.search(r"#define SDA .*?\nstatic void twi_begin\(void\)\n\{.*?\n\}\n", sketch, re.DOTALL)
    assert found is not None
    folder = tmp_path_factory.mktemp("bus")
    (folder / "bus.c").write_text(MODEL % found[0])
    subprocess.run(["cc", "-w", "-o", str(folder / "bus"), str(folder / "bus.c")], check=True)
    return folder / "bus"


def freed(bus: Path, *words: int) -> tuple[int, int, int, int]:
    """Whether the DAC took a byte, which, its state, whether SDA is free."""
    said = subprocess.run([str(bus), *map(str, words)], capture_output=True, text=True, check=True).stdout.split()
    took, latched, state, free = map(int, said)
    return took, latched, state, free


@pytest.mark.parametrize("master_sda", [0, 1])
@pytest.mark.parametrize("bits", range(9))
def test_a_byte_that_was_half_sent_is_never_filled_with_ones(bus: Path, bits: int, master_sda: int) -> None:
    """The low byte of a code is under way, all zeros so far: what the DAC takes, if anything, is no more."""
    took, latched, state, free = freed(bus, 0, bits, 0, 0, master_sda)
    assert free and state == 3
    assert not took or latched == 0


def test_a_dac_that_acknowledges_lets_go_and_keeps_what_was_sent(bus: Path) -> None:
    took, latched, state, free = freed(bus, 1, 8, 0x5A, 0, 1)
    assert free and state == 3 and (not took or latched == 0x5A)


@pytest.mark.parametrize("sends", [0x00, 0x01, 0x80, 0xFF, 0x55])
@pytest.mark.parametrize("bits", range(8))
def test_a_dac_that_sends_lets_go(bus: Path, bits: int, sends: int) -> None:
    took, _, state, free = freed(bus, 2, bits, 0, sends, 1)
    assert free and state == 3 and not took
