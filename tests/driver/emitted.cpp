// The emitted cards in Verilator: takes the lines of the driver's hooks, and does them on the pins of AXI4-Lite, or of SPI (argument spi).
#include "Vemitted.h"
#include "verilated.h"
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>

static VerilatedContext *context;
static Vemitted *top;
static unsigned card; // 0 AXI4-Lite, 1 SPI
static uint64_t plug_at_us[2];
static const uint64_t HALF_PS = 62500; // 8 MHz
static const unsigned WIDTH[2] = {29, 25};
static uint32_t spoilt_in[2]; // number of the frame behind the spoilt one

static uint64_t position_of(unsigned channel, uint32_t frame)
{
    return (frame + 1) * (0x9E3779B97F4A7C15u + channel) & ((UINT64_C(1) << WIDTH[channel]) - 1);
}

static uint32_t frames(unsigned channel)
{
    return top->frames[2 * card + channel];
}

static uint64_t now_us()
{
    return context->time() / 1000000;
}

static void run_to(uint64_t time)
{
    while (top->eventsPending() && top->nextTimeSlot() < time) {
        context->time(top->nextTimeSlot());
        top->eval();
    }
    context->time(time);
}

// From behind one rising edge to behind the next.
static void cycle()
{
    for (unsigned n = 0; n < 2; n++) {
        if (plug_at_us[n] != 0 && now_us() >= plug_at_us[n]) {
            plug_at_us[n] = 0;
            top->plugged |= static_cast<uint8_t>(1u << (2 * card + n));
        }
        if (frames(n) >= spoilt_in[n])
            top->spoil_crc &= static_cast<uint8_t>(~(1u << (2 * card + n)));
    }
    top->position_0 = position_of(0, frames(0));
    top->position_1 = position_of(1, frames(1));
    top->eval();
    run_to(context->time() + HALF_PS);
    top->clk = 0;
    top->eval();
    run_to(context->time() + HALF_PS);
    top->clk = static_cast<uint8_t>(1u << card);
    top->eval();
}

static void give_up(const char *what)
{
    std::fprintf(stderr, "emitted: no %s\n", what);
    std::exit(1);
}

static uint32_t read(uint32_t word)
{
    top->araddr = static_cast<uint16_t>(word << 2);
    top->arvalid = 1;
    top->rready = 1;
    for (int n = 0; n < 400; n++) {
        top->eval();
        const bool taken = top->arvalid && top->arready;
        const bool done = top->rvalid;
        const uint32_t value = top->rdata;
        if (done && top->rresp != 0)
            give_up("OKAY");
        cycle();
        if (taken)
            top->arvalid = 0;
        if (done) {
            top->rready = 0;
            return value;
        }
    }
    give_up("RVALID");
    return 0;
}

static void write(uint32_t word, uint32_t value)
{
    top->awaddr = static_cast<uint16_t>(word << 2);
    top->wdata = value;
    top->awvalid = 1;
    top->wvalid = 1;
    top->bready = 1;
    for (int n = 0; n < 400; n++) {
        top->eval();
        const bool address = top->awvalid && top->awready;
        const bool data = top->wvalid && top->wready;
        const bool done = top->bvalid;
        if (done && top->bresp != 0)
            give_up("OKAY");
        cycle();
        if (address)
            top->awvalid = 0;
        if (data)
            top->wvalid = 0;
        if (done) {
            top->bready = 0;
            return;
        }
    }
    give_up("BVALID");
}

// Half a period of the serial clock.
static void half()
{
    for (int n = 0; n < 4; n++)
        cycle();
}

// A frame: bytes as hexadecimal digits, and those that came back.
static std::string transfer(const char *sent)
{
    std::string came;
    top->cs_n = 0;
    half();
    for (unsigned value; std::sscanf(sent, "%2x", &value) == 1; sent += 2) {
        unsigned back = 0;
        for (int bit = 7; bit >= 0; bit--) {
            top->mosi = value >> bit & 1;
            half();
            back = back << 1 | top->miso;
            top->sck = 1;
            half();
            top->sck = 0;
        }
        char digits[3];
        std::snprintf(digits, sizeof digits, "%02x", back);
        came += digits;
    }
    half();
    top->cs_n = 1;
    half();
    return came;
}

static uint64_t answer(const char *what, uint32_t first, uint32_t second)
{
    const uint64_t end = now_us() + first;
    if (std::strcmp(what, "r") == 0)
        return read(first);
    if (std::strcmp(what, "w") == 0) {
        write(first, second);
    } else if (std::strcmp(what, "delay") == 0) {
        while (now_us() < end)
            cycle();
    } else if (std::strcmp(what, "now") == 0) {
        return now_us();
    } else if (std::strcmp(what, "unplug") == 0) {
        top->plugged &= static_cast<uint8_t>(~(1u << (2 * card + first)));
        plug_at_us[first] = now_us() + 1000 * second;
    } else if (std::strcmp(what, "crc") == 0) {
        top->spoil_crc |= static_cast<uint8_t>(1u << (2 * card + first));
        spoilt_in[first] = frames(first) + 1;
    } else if (std::strcmp(what, "position") == 0) {
        // A frame is whole for the encoder when its recovery time is over.
        const uint64_t whole = now_us() + 30;
        while (now_us() < whole)
            cycle();
        return position_of(first, frames(first) - 1);
    } else if (std::strcmp(what, "violations") == 0) {
        return top->errors[2 * card] + top->errors[2 * card + 1];
    } else {
        give_up(what);
    }
    return 0;
}

int main(int count, char **arguments)
{
    context = new VerilatedContext;
    top = new Vemitted{context};
    top->plugged = 15;
    top->cs_n = 1;
    card = count > 1 && std::strcmp(arguments[1], "spi") == 0;
    for (int n = 0; n < 1000; n++)
        cycle();
    char line[4096], what[32];
    while (std::fgets(line, sizeof line, stdin)) {
        unsigned first = 0, second = 0;
        std::sscanf(line, "%31s %x %x", what, &first, &second);
        if (std::strcmp(what, "spi") == 0)
            std::printf("= %s\n", transfer(line + 4).c_str());
        else
            std::printf("= %llx\n", static_cast<unsigned long long>(answer(what, first, second)));
        std::fflush(stdout);
    }
    top->final();
    return 0;
}
