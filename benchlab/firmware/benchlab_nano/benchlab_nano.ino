/*
 * benchlab_nano: an Arduino Nano (ATmega328P, 16 MHz) between a computer and a pressure regulator.
 *
 * It holds the voltage that the regulator follows, and trusts nobody: at boot it sets the DAC to 0 before anything else; it gives
 * no pressure until it is armed; it refuses codes above its ceiling; it slows rises; it vents when nobody speaks, when its own
 * main loop hangs, and when the DAC does not acknowledge. Vent is code 0: it asks the regulator to vent. Use a relief valve too.
 * While it is vented it measures its supply, which is the DAC's reference, so that the computer sees when that has changed.
 *
 * Wiring:  A4 SDA and A5 SCL to the MCP4725 (VCC to 5 V, OUT to the regulator's input, grounds together)
 *          A0 middle of the flex sensor's divider    A1 monitor output of the regulator    D2 trigger of the camera
 *
 * Builds in the Arduino IDE (board "Arduino Nano"), and with plain avr-gcc:
 *     avr-gcc -mmcu=atmega328p -DF_CPU=16000000UL -Os -x c++ benchlab_nano.ino -o benchlab_nano.elf
 * The frames, what each failure does and how to flash: docs/firmware.md of benchlab. MIT licence.
 */

#include <avr/eeprom.h>
#include <avr/interrupt.h>
#include <avr/io.h>
#include <avr/sleep.h>
#include <avr/wdt.h>
#include <util/crc16.h>
#include <util/delay.h>

/* ---- Settings of this bench; `benchlab bench firmware` writes the ceiling of yours ---- */

#define CEILING_CODE 2730    /* codes above are refused: 2730 of 4096 is 3.50 V at the 5.25 V that USB may have, 0.35 MPa at 0.1 MPa/V */
#define SLEW_CODES_PER_MS 40 /* rises only, 1 to 255; falling is never slowed */
#define SILENCE_MS 200       /* armed, and no code taken for this long, 50 to 500: vent */
#define TRIGGER_MS 20        /* length of the camera's pulse, 1 to 255 */
#define DAC_ADDRESS 0x62     /* of the MCP4725: 0x62, or 0x60 to 0x67, as printed on the board */
#define ADC_SAMPLES 8        /* readings are means of so many conversions, one each millisecond; a power of two, at most 32 */

/* ---- What follows needs no change ---- */

#define PROTOCOL 1 /* of the frames; the computer refuses another */
#define VERSION_MAJOR 1
#define VERSION_MINOR 1
#define VERSION_PATCH 1

#define BAUD 500000UL      /* 16 MHz / 16 / 2: exact here, in the FT232 (3 MHz / 6) and in the CH340 (12 MHz / 24) */
#define TWI_HZ 100000UL    /* slow edges of long wires and weak pull-ups are fine */
#define HUNG_MS 100        /* the main loop may not take longer */
#define DAC_REFRESH_MS 10  /* the DAC is told its code again this often: so its loss is noticed, and undone */
#define PARTIAL_MS 3       /* a frame that stops in the middle for this long is thrown away */
#define REFERENCE_SAMPLES 64 /* conversions of the chip's own 1.1 V in a measurement of the supply; at most 64, to fit 16 bits */

#if CEILING_CODE < 0 || CEILING_CODE > 4095
#error "CEILING_CODE must be 0 to 4095"
#endif
#if SLEW_CODES_PER_MS < 1 || SLEW_CODES_PER_MS > 255
#error "SLEW_CODES_PER_MS must be 1 to 255"
#endif
#if SILENCE_MS < 50 || SILENCE_MS > 500
#error "SILENCE_MS must be 50 to 500"
#endif
#if TRIGGER_MS < 1 || TRIGGER_MS > 255
#error "TRIGGER_MS must be 1 to 255"
#endif
#if DAC_ADDRESS < 0x60 || DAC_ADDRESS > 0x67
#error "DAC_ADDRESS must be 0x60 to 0x67"
#endif
#if ADC_SAMPLES < 1 || ADC_SAMPLES > 32 || (ADC_SAMPLES & (ADC_SAMPLES - 1))
#error "ADC_SAMPLES must be 1, 2, 4, 8, 16 or 32"
#endif

enum { SYNC = 0xB5, HEAD = 5, CRC = 2, MOST = 23, ASKED = 3 }; /* bytes: of a head, a CRC, the longest payload, and asked */
enum { HELLO = 1, ARM = 2, SET = 3, VENT = 4, STATUS = 5, ANSWER = 0x80 };
enum { FLEX = 0, MONITOR = 1, REFERENCE = 14 }; /* inputs of the ADC */
enum { ARMED = 1, SLEWING = 2, SILENCE = 4, WATCHDOG = 8, REFUSED = 16, DAC_LOST = 32, REBOOTED = 128 };

#define UNKNOWN 0xFFFF                      /* code of a DAC that does not acknowledge */
#define HUNG_AT ((uint8_t *)0)              /* EEPROM: 1 where the watchdog found the main loop hung */
#define BOOTS_AT ((uint16_t *)2)            /* EEPROM: number of boots */

static uint8_t reset_cause __attribute__((section(".noinit"))); /* MCUSR as it was at boot */

static uint16_t output, target;      /* code that the DAC holds, and that was asked for */
static uint16_t dac_eeprom, boots;   /* code that the DAC takes at power-on; number of boots */
static uint8_t flags, allowance, trigger_ms, since_refresh_ms, spoken_to;
static uint16_t last_number, crc_errors, dropped;
static uint32_t heard_ms;            /* when it was armed, or last took a code */

static volatile uint32_t clock_ms;
static volatile uint8_t hung_ms;     /* since the main loop came by */
static volatile uint16_t samples[2][ADC_SAMPLES]; /* the last conversions: flex, monitor */
static volatile uint16_t reference;  /* sum of the last REFERENCE_SAMPLES conversions of 1.1 V; 0 while they are not done */
static volatile uint8_t in_ring[64], in_head, in_tail, out_ring[64], out_head, out_tail;

static uint8_t inbox[HEAD + ASKED + CRC], in_box;

static void alive(void) /* the main loop comes by */
{
    hung_ms = 0;
    wdt_reset();
}

/* ---- Two-wire bus: nothing here waits for ever ---- */

static uint8_t twi(uint8_t what) /* do it, wait 1 ms at most; the status, or 0 where the bus hangs */
{
    TWCR = what | (1 << TWINT) | (1 << TWEN);
    _delay_us(12); /* a byte takes 90; simavr 1.6 shows the old TWINT and status for the first 9 */
    for (uint16_t n = 0; n < 2000; n++)
        if (TWCR & (1 << TWINT))
            return TWSR & 0xF8;
    return 0;
}

static void twi_stop(void)
{
    TWCR = (1 << TWINT) | (1 << TWEN) | (1 << TWSTO);
    for (uint8_t n = 0; n < 200 && (TWCR & (1 << TWSTO)); n++)
        ;
}

#define SDA (1 << PC4)
#define SCL (1 << PC5)

static void twi_line(uint8_t line, uint8_t low) /* pull it low, or let it rise */
{
    if (low)
        DDRC |= line;
    else
        DDRC &= ~line;
    _delay_us(5);
}

/* Let go of the bus, free it from a DAC that holds it, take it again. A DAC that was left in the middle of a byte must not take what is
 * clocked here for the rest of it, as ones above all. So SDA is low when SCL is let go: a bit that was under way ends as a 0; then SDA
 * rises while SCL is high, which is a stop. SCL is clocked only while the DAC itself holds SDA low, to send or to acknowledge. */
static void twi_begin(void)
{
    PORTC &= ~(SDA | SCL);
    DDRC = (DDRC & ~SCL) | SDA;
    TWCR = 0;
    _delay_us(5);
    twi_line(SDA, 0);
    for (uint8_t n = 0; n < 9 && !(PINC & SDA); n++) {
        twi_line(SCL, 1);
        twi_line(SCL, 0);
    }
    twi_line(SDA, 1); /* start and stop, without a clock: whatever was under way has ended */
    twi_line(SDA, 0);
    PORTC |= SDA | SCL; /* weak pull-ups beside those of the board */
    TWSR = 0;
    TWBR = (F_CPU / TWI_HZ - 16) / 2;
    TWCR = 1 << TWEN;
}

static uint8_t twi_address(uint8_t read)
{
    uint8_t status = twi(1 << TWSTA);
    if (status != 0x08 && status != 0x10)
        return 0;
    TWDR = (uint8_t)(DAC_ADDRESS << 1) | read;
    status = twi(0);
    return status == 0x18 || status == 0x28 || status == 0x40; /* 0x28: what simavr 1.6 says for 0x18 */
}

static uint8_t twi_byte(uint8_t byte)
{
    TWDR = byte;
    return twi(0) == 0x28;
}

/* ---- DAC ---- */

static uint8_t dac_write(uint16_t code) /* 1 where the DAC acknowledged all of it */
{
    uint8_t done = twi_address(0) && twi_byte(code >> 8) && twi_byte(code & 0xFF);
    twi_stop();
    return done;
}

static uint8_t dac_read(uint8_t *five) /* status, code (2), EEPROM (2) */
{
    uint8_t n = 0;
    if (twi_address(1))
        for (; n < 5; n++) {
            uint8_t status = twi(n < 4 ? 1 << TWEA : 0);
            if (status != 0x50 && status != 0x58)
                break;
            five[n] = TWDR;
        }
    twi_stop();
    return n == 5;
}

static void vent(void);

static void dac_put(uint16_t code) /* whoever asks, for whatever reason: nothing above the ceiling passes here */
{
    since_refresh_ms = 0;
    if (code > CEILING_CODE) {
        flags &= ~ARMED;
        code = target = 0;
    }
    if (!dac_write(code)) {
        twi_begin();
        if (!dac_write(code)) {
            output = UNKNOWN;
            target = 0;
            flags = (flags & ~ARMED) | DAC_LOST;
            return;
        }
    }
    output = code;
}

static uint8_t dac_is_zero(void) /* what it holds is read back: an acknowledgement only says that something heard it */
{
    uint8_t five[5];
    return dac_read(five) && (five[1] | (five[2] & 0xF0)) == 0;
}

static void vent(void)
{
    flags &= ~ARMED;
    target = 0;
    dac_put(0);
    if (output == 0 && !dac_is_zero() && !dac_is_zero()) {
        output = UNKNOWN;
        flags |= DAC_LOST;
    }
}

static void drive(void) /* towards the target: down at once, up by what is allowed in this millisecond */
{
    uint16_t next = target;
    if (output == UNKNOWN)
        return;
    if (target > output) {
        if (target - output > allowance)
            next = output + allowance;
        allowance -= next - output;
    }
    if (next != output)
        dac_put(next);
    if (output == target || output == UNKNOWN)
        flags &= ~SLEWING;
    else
        flags |= SLEWING;
}

static void dac_forget(void) /* program the code that the DAC takes at power-on to 0, unless it is */
{
    uint8_t five[5], tries = 0;
    dac_eeprom = UNKNOWN;
    if (!dac_read(five))
        return;
    if (((five[3] & 0x0F) | five[4]) != 0) {
        if (twi_address(0) && twi_byte(0x60) && twi_byte(0))
            twi_byte(0);
        twi_stop();
        do {
            alive();
            _delay_ms(1);
        } while (++tries < 100 && !(dac_read(five) && (five[0] & 0x80)));
    }
    dac_eeprom = (uint16_t)(five[3] & 0x0F) << 8 | five[4];
}

/* ---- Watchdog ---- */

static void watchdog_begin(void)
{
    wdt_enable(WDTO_250MS); /* to the reset, interrupts or none; on the way there, `hung` has vented long ago */
}

/* In the clock's interrupt, as the main loop is stuck: vent, remember why, and let the watchdog reset. */
static void hung(void)
{
    twi_begin();
    if (!dac_write(0))
        dac_write(0);
    eeprom_update_byte(HUNG_AT, 1);
    for (;;)
        ;
}

/* The watchdog outlives the reset that it causes: it is stopped before anything else runs. */
void first_of_all(void) __attribute__((naked, used, section(".init3")));
void first_of_all(void)
{
    reset_cause = MCUSR;
    MCUSR = 0;
    wdt_disable();
}

/* ---- Clock and ADC ---- */

static void listen_to(uint8_t input) /* against the supply */
{
    ADMUX = (1 << REFS0) | input;
}

static void convert(uint8_t input)
{
    listen_to(input);
    ADCSRA |= 1 << ADSC;
}

/* Each millisecond: the reference, while not armed, then flex, then monitor. The reference is weak and takes 0.35 ms to pull the ADC
 * down from the monitor's volts: it is listened to from the end of the one millisecond's conversions to the start of the next. */
ISR(TIMER1_COMPA_vect)
{
    clock_ms++;
    convert((ADMUX & 15) == REFERENCE ? REFERENCE : FLEX);
    if (++hung_ms >= HUNG_MS)
        hung();
}

ISR(ADC_vect)
{
    static uint8_t at, summed;
    static uint16_t sum;
    switch (ADMUX & 15) {
    case REFERENCE:
        sum += ADC;
        if (++summed == REFERENCE_SAMPLES) {
            reference = sum;
            sum = summed = 0;
        }
        convert(FLEX);
        break;
    case FLEX:
        samples[0][at] = ADC;
        convert(MONITOR);
        break;
    default:
        samples[1][at] = ADC;
        at = (at + 1) % ADC_SAMPLES;
        if (flags & ARMED)
            reference = sum = summed = 0; /* measured anew after the vent */
        else
            listen_to(REFERENCE);
    }
}

static uint32_t now_ms(void)
{
    cli();
    uint32_t ms = clock_ms;
    sei();
    return ms;
}

static uint32_t now_us(void)
{
    cli();
    uint32_t ms = clock_ms;
    uint16_t half_us = TCNT1;
    if ((TIFR1 & (1 << OCF1A)) && half_us < 1000)
        ms++;
    sei();
    return ms * 1000 + half_us / 2;
}

static uint16_t sum_of_reference(void)
{
    cli();
    uint16_t sum = reference;
    sei();
    return sum;
}

static uint16_t sum_of(uint8_t sensor)
{
    uint16_t sum = 0;
    for (uint8_t n = 0; n < ADC_SAMPLES; n++) {
        cli();
        sum += samples[sensor][n];
        sei();
    }
    return sum;
}

/* ---- Serial line ---- */

ISR(USART_RX_vect)
{
    uint8_t byte = UDR0, next = (in_head + 1) % sizeof in_ring;
    if (next != in_tail) {
        in_ring[in_head] = byte;
        in_head = next;
    }
}

ISR(USART_UDRE_vect)
{
    if (out_tail == out_head) {
        UCSR0B &= ~(1 << UDRIE0);
        return;
    }
    UDR0 = out_ring[out_tail];
    out_tail = (out_tail + 1) % sizeof out_ring;
}

static void say(uint8_t byte)
{
    out_ring[out_head] = byte;
    out_head = (out_head + 1) % sizeof out_ring;
}

static void answer(uint16_t number, uint8_t command, const uint8_t *payload, uint8_t size)
{
    uint8_t free_bytes = (uint8_t)(out_tail - out_head - 1) % sizeof out_ring;
    uint8_t head[HEAD] = {SYNC, size, (uint8_t)number, (uint8_t)(number >> 8), (uint8_t)(command | ANSWER)};
    uint16_t crc = 0xFFFF;
    if (free_bytes < HEAD + size + CRC) {
        dropped++;
        return;
    }
    for (uint8_t n = 0; n < HEAD + size; n++) {
        uint8_t byte = n < HEAD ? head[n] : payload[n - HEAD];
        if (n)
            crc = _crc_xmodem_update(crc, byte);
        say(byte);
    }
    say(crc & 0xFF);
    say(crc >> 8);
    UCSR0B |= 1 << UDRIE0;
}

static uint8_t *put16(uint8_t *at, uint16_t value)
{
    *at++ = value & 0xFF;
    *at++ = value >> 8;
    return at;
}

static void tell_hello(uint16_t number)
{
    uint8_t payload[MOST] = {PROTOCOL, VERSION_MAJOR, VERSION_MINOR, VERSION_PATCH};
    uint8_t *at = put16(payload + 4, CEILING_CODE);
    at = put16(at, SLEW_CODES_PER_MS);
    at = put16(at, SILENCE_MS);
    at = put16(at, HUNG_MS);
    at = put16(at, boots);
    at = put16(at, dac_eeprom);
    *at++ = reset_cause;
    *at++ = ADC_SAMPLES;
    *at++ = DAC_ADDRESS;
    *at++ = flags;
    at = put16(at, sum_of_reference());
    *at++ = REFERENCE_SAMPLES;
    answer(number, HELLO, payload, at - payload);
}

static void tell(uint16_t number, uint8_t command)
{
    uint8_t payload[MOST];
    uint32_t us = now_us();
    uint8_t *at = put16(payload, output);
    at = put16(at, sum_of(0));
    at = put16(at, sum_of(1));
    at = put16(at, flags);
    at = put16(at, us & 0xFFFF);
    at = put16(at, us >> 16);
    at = put16(at, boots);
    at = put16(at, crc_errors);
    at = put16(at, dropped);
    answer(number, command, payload, at - payload);
}

/* ---- Commands ---- */

static void arm(uint16_t for_boot)
{
    if (for_boot != boots || output != 0) { /* said to another boot, or the DAC does not answer */
        flags |= REFUSED;
        return;
    }
    flags = (flags & WATCHDOG) | ARMED;
    heard_ms = now_ms();
}

static void set(uint16_t code, uint8_t trigger)
{
    if (code > CEILING_CODE || (code && !(flags & ARMED))) {
        flags |= REFUSED;
        return;
    }
    target = code;
    heard_ms = now_ms(); /* nothing else keeps it armed: a computer that only asks, or asks for too much, does not drive it */
    drive();
    if (trigger) {
        PORTD |= 1 << PD2;
        trigger_ms = TRIGGER_MS;
    }
}

static void obey(uint16_t number, uint8_t command, const uint8_t *payload, uint8_t size)
{
    uint16_t value = size >= 2 ? payload[0] | payload[1] << 8 : 0;
    int16_t ahead;
    if (!spoken_to) { /* since boot: whatever the number, it is new */
        spoken_to = 1;
        last_number = number - 1;
    }
    ahead = number - last_number;
    if (command == HELLO || command == VENT) { /* at any time and with any number: both can only vent */
        vent();
        flags &= ~(REFUSED | SLEWING);
    } else if (ahead < 0) {
        dropped++; /* an old command, late */
        return;
    } else if (ahead > 0) { /* else: the same again, as its answer was lost; it is only answered */
        flags &= ~REFUSED;
        if (command == ARM)
            arm(value);
        else if (command == SET)
            set(value, payload[2] & 1);
    }
    if (command == HELLO || ahead > 0)
        last_number = number;
    if (command == HELLO)
        tell_hello(number);
    else
        tell(number, command);
}

static uint8_t size_of(uint8_t command) /* of what is asked; 255 for no command */
{
    switch (command) {
    case HELLO:
    case VENT:
    case STATUS:
        return 0;
    case ARM:
        return 2;
    case SET:
        return 3;
    }
    return 255;
}

static void forget(uint8_t bytes)
{
    in_box -= bytes;
    for (uint8_t n = 0; n < in_box; n++)
        inbox[n] = inbox[n + bytes];
}

static void open_inbox(void) /* obey each whole frame in it; what is none is passed over, byte by byte, and counted once */
{
    static uint8_t astray;
    while (in_box) {
        uint8_t size = in_box > 1 ? inbox[1] : 0, whole = HEAD + size + CRC;
        uint16_t crc = 0xFFFF;
        if (inbox[0] != SYNC || size > ASKED) {
            dropped += !astray;
            astray = 1;
            forget(1);
            continue;
        }
        if (in_box < whole)
            return;
        for (uint8_t n = 1; n < HEAD + size; n++)
            crc = _crc_xmodem_update(crc, inbox[n]);
        if (inbox[HEAD + size] != (crc & 0xFF) || inbox[HEAD + size + 1] != crc >> 8) {
            crc_errors++;
            astray = 1;
            forget(1);
            continue;
        }
        astray = 0;
        if (size == size_of(inbox[4]))
            obey(inbox[2] | inbox[3] << 8, inbox[4], inbox + HEAD, size);
        else
            dropped++;
        forget(whole);
    }
}

static void hear(void)
{
    static uint8_t last_ms;
    uint8_t ms = clock_ms; /* its low byte */
    if (in_tail != in_head)
        last_ms = ms;
    else if (in_box && (uint8_t)(ms - last_ms) >= PARTIAL_MS) {
        inbox[0] = 0; /* no frame begins here after all */
        open_inbox();
    }
    while (in_tail != in_head) {
        inbox[in_box++] = in_ring[in_tail];
        in_tail = (in_tail + 1) % sizeof in_ring;
        if (in_box >= HEAD + CRC)
            open_inbox();
    }
}

/* ---- Main loop ---- */

static void each_ms(uint32_t ms)
{
    allowance = SLEW_CODES_PER_MS;
    if (trigger_ms && !--trigger_ms)
        PORTD &= ~(1 << PD2);
    if ((flags & ARMED) && ms - heard_ms >= SILENCE_MS) {
        vent();
        flags |= SILENCE;
    }
    drive();
    if (++since_refresh_ms >= DAC_REFRESH_MS)
        dac_put(output == UNKNOWN ? 0 : output);
}

void setup(void)
{
    twi_begin();
    vent(); /* before anything else */
    PORTD &= ~(1 << PD2);
    DDRD |= 1 << PD2;
    watchdog_begin();
    dac_forget();
    boots = eeprom_read_word(BOOTS_AT) + 1;
    eeprom_update_word(BOOTS_AT, boots);
    flags |= REBOOTED;
    if (eeprom_read_byte(HUNG_AT) == 1 || (reset_cause & (1 << WDRF)))
        flags |= WATCHDOG;
    eeprom_update_byte(HUNG_AT, 0);

    ADCSRA = (1 << ADEN) | (1 << ADIE) | 7; /* 125 kHz: a conversion takes 0.1 ms */
    DIDR0 = 3;
    TCCR1A = 0;
    TCCR1B = (1 << WGM12) | (1 << CS11); /* counts half microseconds */
    OCR1A = 1999;
    TIMSK1 = 1 << OCIE1A;
    UBRR0 = F_CPU / 16 / BAUD - 1;
    UCSR0A = 0;
    UCSR0C = (1 << UCSZ01) | (1 << UCSZ00);
    UCSR0B = (1 << RXEN0) | (1 << TXEN0) | (1 << RXCIE0);
    set_sleep_mode(SLEEP_MODE_IDLE);
    sei();
}

void loop(void)
{
    static uint8_t done_ms; /* low byte of the last millisecond seen to */
    alive();
    if ((uint8_t)clock_ms != done_ms) {
        uint32_t ms = now_ms();
        done_ms = ms;
        each_ms(ms);
    }
    hear();
    cli();
    while ((uint8_t)clock_ms == done_ms && in_tail == in_head) { /* nothing to do until an interrupt brings something */
        sleep_enable();
        sei();
        sleep_cpu();
        sleep_disable();
        cli();
    }
    sei();
}

#ifndef ARDUINO
int main(void)
{
    setup();
    for (;;)
        loop();
}
#endif
