/*
 * Runs the firmware of the Nano in simavr, with an MCP4725 on its two-wire bus, a regulator that lags and two sensors.
 * A process of its own, told what to do by lines on standard input; it ends when that is closed.
 *
 *     emulator FIRMWARE.elf lockstep|pty SUPPLY_mV REFERENCE_mV MONITOR_mV MONITOR_GAIN FLEX_mV FLEX_GAIN [LOG]
 *
 * SUPPLY_mV is the reference of DAC and ADC. REFERENCE_mV is the chip's own, nominally 1100, which its ADC can measure.
 * The monitor shows MONITOR_mV + MONITOR_GAIN · (volts at the DAC, lagged by LAG_S), and so does the flex sensor.
 * It says `ready`, or the name of its pty; then each line is answered by `T CODE EEPROM TRIGGERS HEX`: virtual microseconds, the codes
 * of the DAC and of its memory, pulses for the camera so far, and bytes that the firmware sent (`-` for none).
 *
 *     run T              let it go on until T (lockstep: time moves by this and the next alone)
 *     ask T1 T2 HEX      let it go on until T1, give it these bytes, and go on until it has answered, or T2
 *     dac lost|back|skip take the DAC off the bus; for one command        flex MV|auto, monitor MV|auto   hold a sensor
 *     supply MV          another supply, of everything but the regulator and the sensors
 *     hang, deaf         the main loop hangs; with interrupts off             reset, power  as the button, as the plug
 *     memory CODE        what the DAC takes at power-on   state              nothing
 *
 * LOG gets a line for each event: CLOCK_MONOTONIC seconds, virtual microseconds, what, value.
 * Part of benchlab, MIT licence. simavr, which it is linked with where it is compiled, is GPL-3: this program is not shipped compiled.
 */

#define _GNU_SOURCE
#include <fcntl.h>
#include <math.h>
#include <poll.h>
#include <sched.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <termios.h>
#include <time.h>
#include <unistd.h>

#include <simavr/avr_adc.h>
#include <simavr/avr_extint.h>
#include <simavr/avr_ioport.h>
#include <simavr/avr_twi.h>
#include <simavr/avr_uart.h>
#include <simavr/sim_avr.h>
#include <simavr/sim_elf.h>
#include <simavr/sim_time.h>

#define MHZ 16
#define BYTE_CYCLES (20 * MHZ)   /* ten bits at 500,000 baud */
#define QUIET_CYCLES (100 * MHZ) /* an answer has ended */
#define LAG_S 0.1
#define MCUSR_AT 0x54
#define TRAP 0x7FF0 /* unused flash, where `rjmp .` is put */
#define REFERENCE_MUX 14
#define FLEX 0
#define MONITOR 1

static avr_t *avr;
static avr_irq_t *to_twi, *to_adc[2], *to_uart;
static FILE *event_log;
static uint8_t feed[1 << 17], said[1 << 17];
static unsigned feed_at, feed_end, said_end, triggers;
static avr_cycle_count_t next_feed, last_said;

static struct {
    unsigned code, memory, here, skip, stuck, selected, index;
    uint8_t bytes[8];
} dac = {.code = 0x800, .memory = 0x800, .here = 1}; /* as delivered: half of full scale at power-on */
static struct { double volts; avr_cycle_count_t at; } regulator;
static struct { double offset_mV, gain, held_mV; } sensor[2];

static double monotonic_s(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return t.tv_sec + t.tv_nsec / 1e9;
}

static void note(const char *what, unsigned value)
{
    if (event_log)
        fprintf(event_log, "%.6f %llu %s %u\n", monotonic_s(), (unsigned long long)(avr->cycle / MHZ), what, value);
}

/* ---- MCP4725: fast writes, writes with memory, reads ---- */

static void dac_take(uint8_t byte)
{
    uint8_t *b = dac.bytes;
    unsigned first = dac.index == 0;
    b[dac.index++ & 7] = byte;
    if (first || dac.stuck)
        return;
    if ((b[0] & 0xC0) == 0 && dac.index == 2) { /* fast: 0 0 PD1 PD0 D11..8, D7..0 */
        dac.code = (b[0] & 0x0F) << 8 | b[1];
        dac.index = 0;
    } else if ((b[0] & 0xC0) == 0x40 && dac.index == 3) { /* C2 C1 C0 x x PD1 PD0 x, D11..4, D3..0 */
        dac.code = b[1] << 4 | b[2] >> 4;
        if ((b[0] & 0xE0) == 0x60) {
            dac.memory = dac.code;
            note("memory", dac.memory);
        }
        dac.index = 0;
    } else {
        return;
    }
    note("dac", dac.code);
}

static uint8_t dac_give(void)
{
    uint8_t five[5] = {0xC0, dac.code >> 4, dac.code << 4, dac.memory >> 8, dac.memory};
    return five[dac.index++ % 5];
}

static void regulator_follow(void);

static void on_twi(struct avr_irq_t *irq, uint32_t value, void *param)
{
    avr_twi_msg_irq_t v = {.u.v = value};
    (void)irq, (void)param;
    if (v.u.twi.msg & (TWI_COND_STOP | TWI_COND_START))
        dac.selected = dac.index = 0;
    if (!dac.here)
        return;
    if (v.u.twi.msg & TWI_COND_START && (v.u.twi.addr & ~1) == 0x62 << 1) {
        if (dac.skip) {
            dac.skip = 0;
            return;
        }
        dac.selected = v.u.twi.addr;
        avr_raise_irq(to_twi, avr_twi_irq_msg(TWI_COND_ACK, dac.selected, 1));
    }
    if (!dac.selected)
        return;
    if (v.u.twi.msg & TWI_COND_WRITE) {
        avr_raise_irq(to_twi, avr_twi_irq_msg(TWI_COND_ACK, dac.selected, 1));
        regulator_follow();
        dac_take(v.u.twi.data);
    }
    if (v.u.twi.msg & TWI_COND_READ)
        avr_raise_irq(to_twi, avr_twi_irq_msg(TWI_COND_READ, dac.selected, dac_give()));
}

/* ---- Regulator and sensors ---- */

static void regulator_follow(void)
{
    double gone_s = (avr->cycle - regulator.at) / (MHZ * 1e6), asked = avr->vcc / 1000.0 * dac.code / 4096;
    regulator.volts += (asked - regulator.volts) * -expm1(-gone_s / LAG_S);
    regulator.at = avr->cycle;
}

static void on_conversion(struct avr_irq_t *irq, uint32_t value, void *param)
{
    (void)irq, (void)value, (void)param;
    regulator_follow();
    for (int n = 0; n < 2; n++) {
        double mV = sensor[n].offset_mV + 1000 * sensor[n].gain * regulator.volts;
        if (!isnan(sensor[n].held_mV))
            mV = sensor[n].held_mV;
        mV = mV < 0 ? 0 : mV > avr->vcc ? avr->vcc : mV;
        avr_raise_irq(to_adc[n], (uint32_t)lround(mV));
    }
}

static void on_trigger(struct avr_irq_t *irq, uint32_t value, void *param)
{
    (void)param;
    if (value && !irq->value)
        note("trigger", ++triggers);
    else if (!value && irq->value)
        note("released", triggers);
}

static void on_byte(struct avr_irq_t *irq, uint32_t value, void *param)
{
    (void)irq, (void)param;
    if (said_end < sizeof said)
        said[said_end++] = value;
    last_said = avr->cycle;
}

/* ---- The Nano ---- */

static void no_sleep(avr_t *a, avr_cycle_count_t cycles) { (void)a, (void)cycles; }

static void no_words(avr_t *a, const int level, const char *format, va_list list) { (void)a, (void)level, (void)format, (void)list; }

static avr_cycle_count_t horizon(avr_t *a, avr_cycle_count_t when, void *param)
{
    (void)a, (void)when, (void)param;
    return 0;
}

static void go_to(avr_cycle_count_t cycle)
{
    if (cycle <= avr->cycle)
        return;
    avr_cycle_timer_cancel(avr, horizon, NULL); /* so that the core sleeps no longer than until then */
    avr_cycle_timer_register(avr, cycle - avr->cycle, horizon, NULL);
    while (avr->cycle < cycle) {
        int state = avr_run(avr);
        if (state == cpu_Done || state == cpu_Crashed) {
            fprintf(stderr, "the emulated Nano crashed at %llu us\n", (unsigned long long)(avr->cycle / MHZ));
            exit(1);
        }
    }
}

static void run_until(avr_cycle_count_t cycle, int stop_when_said)
{
    while (avr->cycle < cycle) {
        avr_cycle_count_t next = cycle;
        if (feed_at < feed_end && next_feed < next)
            next = next_feed;
        if (stop_when_said && said_end && last_said + QUIET_CYCLES < next)
            next = last_said + QUIET_CYCLES;
        if (stop_when_said && !said_end && avr->cycle + QUIET_CYCLES < next)
            next = avr->cycle + QUIET_CYCLES;
        go_to(next);
        if (feed_at < feed_end && avr->cycle >= next_feed) {
            avr_raise_irq(to_uart, feed[feed_at++]);
            next_feed = avr->cycle + BYTE_CYCLES;
        }
        if (stop_when_said && said_end && avr->cycle >= last_said + QUIET_CYCLES)
            return;
    }
}

static void hear(const uint8_t *bytes, unsigned size)
{
    if (feed_at == feed_end)
        feed_at = feed_end = 0;
    for (unsigned n = 0; n < size && feed_end < sizeof feed; n++)
        feed[feed_end++] = bytes[n];
    if (next_feed < avr->cycle)
        next_feed = avr->cycle;
}

static void boot(unsigned cause)
{
    uint32_t flags = 0;
    avr_reset(avr);
    avr->data[MCUSR_AT] = cause;
    avr_ioctl(avr, AVR_IOCTL_UART_SET_FLAGS('0'), &flags);
    avr->run = avr_callback_run_raw;
    avr_extint_set_strict_lvl_trig(avr, 0, 0); /* D2 is INT0 too, whose low level simavr would ask for at each cycle */
    note("boot", cause);
}

static void hang(int deaf)
{
    while (!avr->sreg[S_I]) /* not in the middle of an interrupt */
        avr_run(avr);
    avr->flash[TRAP] = 0xFF;
    avr->flash[TRAP + 1] = 0xCF;
    avr->pc = TRAP;
    avr->state = cpu_Running;
    if (deaf)
        avr->sreg[S_I] = 0;
    note("hang", deaf);
}

static void supply(int mV)
{
    avr->vcc = avr->avcc = avr->aref = mV;
}

static void reference(int mV)
{
    for (avr_io_t *io = avr->io_port; io; io = io->next)
        if (!strcmp(io->kind, "adc"))
            ((avr_adc_t *)io)->muxmode[REFERENCE_MUX].src = mV;
}

static void begin(const char *path, char **words)
{
    elf_firmware_t firmware = {0};
    uint32_t flags = 0;
    avr_global_logger_set(no_words);
    if (elf_read_firmware(path, &firmware) || !(avr = avr_make_mcu_by_name("atmega328p"))) {
        fprintf(stderr, "cannot read %s\n", path);
        exit(1);
    }
    avr_init(avr);
    firmware.frequency = MHZ * 1000000;
    avr_load_firmware(avr, &firmware);
    avr->frequency = MHZ * 1000000;
    supply(atoi(words[0]));
    reference(atoi(words[1]));
    for (int n = 0; n < 2; n++) { /* monitor first, as it is asked first */
        int which = n ? FLEX : MONITOR;
        sensor[which].offset_mV = atof(words[2 + 2 * n]);
        sensor[which].gain = atof(words[3 + 2 * n]);
        sensor[which].held_mV = NAN;
    }
    avr->sleep = no_sleep;
    avr_ioctl(avr, AVR_IOCTL_UART_SET_FLAGS('0'), &flags);
    to_uart = avr_io_getirq(avr, AVR_IOCTL_UART_GETIRQ('0'), UART_IRQ_INPUT);
    to_twi = avr_io_getirq(avr, AVR_IOCTL_TWI_GETIRQ(0), TWI_IRQ_INPUT);
    for (int n = 0; n < 2; n++)
        to_adc[n] = avr_io_getirq(avr, AVR_IOCTL_ADC_GETIRQ, ADC_IRQ_ADC0 + n);
    avr_irq_register_notify(avr_io_getirq(avr, AVR_IOCTL_UART_GETIRQ('0'), UART_IRQ_OUTPUT), on_byte, NULL);
    avr_irq_register_notify(avr_io_getirq(avr, AVR_IOCTL_TWI_GETIRQ(0), TWI_IRQ_OUTPUT), on_twi, NULL);
    avr_irq_register_notify(avr_io_getirq(avr, AVR_IOCTL_ADC_GETIRQ, ADC_IRQ_OUT_TRIGGER), on_conversion, NULL);
    avr_irq_register_notify(avr_io_getirq(avr, AVR_IOCTL_IOPORT_GETIRQ('D'), 2), on_trigger, NULL);
    boot(1);
}

/* ---- What it is told ---- */

static void hold(int which, const char *value) { sensor[which].held_mV = strcmp(value, "auto") ? atof(value) : NAN; }

static void hear_hex(const char *hex)
{
    unsigned byte;
    for (; *hex != '-' && sscanf(hex, "%2x", &byte) == 1; hex += 2) {
        uint8_t one = byte;
        hear(&one, 1);
    }
}

static void obey(char *line, int lockstep)
{
    char *what = strtok(line, " \n"), *value = strtok(NULL, " \n"), *until = strtok(NULL, " \n"), *hex = strtok(NULL, " \n");
    if (!what)
        what = "";
    if (!value)
        value = "";
    if (lockstep && !strcmp(what, "run")) {
        run_until(strtoull(value, NULL, 10) * MHZ, 0);
    } else if (lockstep && !strcmp(what, "ask") && until && hex) {
        run_until(strtoull(value, NULL, 10) * MHZ, 0);
        hear_hex(hex);
        run_until(strtoull(until, NULL, 10) * MHZ, 1);
    } else if (!strcmp(what, "dac")) {
        dac.skip = !strcmp(value, "skip");
        dac.stuck = !strcmp(value, "stuck");
        dac.here = strcmp(value, "lost") != 0;
        note(value, 0);
    } else if (!strcmp(what, "flex")) {
        hold(FLEX, value);
    } else if (!strcmp(what, "monitor")) {
        hold(MONITOR, value);
    } else if (!strcmp(what, "supply")) {
        regulator_follow();
        supply(atoi(value));
    } else if (!strcmp(what, "hang") || !strcmp(what, "deaf")) {
        hang(*what == 'd');
    } else if (!strcmp(what, "reset")) {
        boot(2);
    } else if (!strcmp(what, "power")) {
        memset(avr->data + 0x100, 0xA5, 2048);
        dac.code = dac.memory;
        boot(1);
    } else if (!strcmp(what, "memory")) {
        dac.memory = atoi(value) & 0xFFF;
    } else if (strcmp(what, "state")) {
        fprintf(stderr, "no such command: %s\n", what);
        exit(1);
    }
    printf("%llu %u %u %u ", (unsigned long long)(avr->cycle / MHZ), dac.code, dac.memory, triggers);
    for (unsigned n = 0; lockstep && n < said_end; n++)
        printf("%02x", said[n]);
    puts(lockstep && said_end ? "" : "-");
    fflush(stdout);
    if (lockstep)
        said_end = 0;
}

static int open_pty(void)
{
    struct termios raw;
    int master = posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK);
    if (master < 0 || grantpt(master) || unlockpt(master)) {
        perror("pty");
        exit(1);
    }
    int slave = open(ptsname(master), O_RDWR | O_NOCTTY); /* stays open, so that a host may come and go */
    tcgetattr(slave, &raw);
    cfmakeraw(&raw);
    tcsetattr(slave, TCSANOW, &raw);
    puts(ptsname(master));
    return master;
}

static void live(int pty) /* in real time; time that the computer spent elsewhere is lost, not made up for, past 50 ms */
{
    char line[256];
    uint8_t bytes[256];
    double began = monotonic_s();
    struct sched_param first = {.sched_priority = 1};
    sched_setscheduler(0, SCHED_RR, &first); /* where it may: a real Nano does not wait for the computer's other work */
    for (;;) {
        struct pollfd fds[2] = {{.fd = pty, .events = POLLIN}, {.fd = STDIN_FILENO, .events = POLLIN}};
        struct timespec patience = {0, 250000};
        ppoll(fds, 2, &patience, NULL);
        double now = monotonic_s(), behind = now - began - avr->cycle / (MHZ * 1e6);
        if (behind > 0.05)
            began += behind - 0.05;
        run_until((avr_cycle_count_t)((now - began) * MHZ * 1e6), 0);
        ssize_t got = fds[0].revents & POLLIN ? read(pty, bytes, sizeof bytes) : 0;
        if (got > 0)
            hear(bytes, got);
        if (said_end) {
            ssize_t put = write(pty, said, said_end); /* a host that does not read loses bytes, as on a real line */
            (void)put;
            said_end = 0;
        }
        if (fds[1].revents) {
            if (!fgets(line, sizeof line, stdin))
                return;
            obey(line, 0);
        }
    }
}

int main(int count, char **words)
{
    static char line[1 << 18];
    if (count < 9) {
        fprintf(stderr, "emulator FIRMWARE.elf lockstep|pty SUPPLY_mV REFERENCE_mV MONITOR_mV MONITOR_GAIN FLEX_mV FLEX_GAIN [LOG]\n");
        return 2;
    }
    if (count > 9 && !(event_log = fopen(words[9], "w"))) {
        perror(words[9]);
        return 1;
    }
    if (event_log)
        setvbuf(event_log, NULL, _IOLBF, 0);
    begin(words[1], words + 3);
    if (!strcmp(words[2], "pty")) {
        int pty = open_pty();
        fflush(stdout);
        live(pty);
        return 0;
    }
    puts("ready");
    fflush(stdout);
    while (fgets(line, sizeof line, stdin))
        obey(line, 1);
    return 0;
}
