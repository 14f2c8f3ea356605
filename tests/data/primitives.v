// Clock managers of board tops, as far as a simulator needs them; the real ones come with the tools of their families.
// Factors are decoded as the vendors' manuals have them, so that a wrong parameter makes a wrong clock.

`timescale 1ns / 1ps
`default_nettype none

// Measures a clock and makes another one of it: times, divided by.
module clock_model #(
    parameter integer TIMES = 1,
    parameter integer DIVIDE = 1
) (
    input wire clk_i,
    output wire clk_o,
    output wire locked_o
);
`ifdef VERILATOR
    // Lint only: real delays would be warned about.
    assign clk_o = clk_i;
    assign locked_o = 1'b1;
    wire unused = TIMES > DIVIDE;
`else
    reg clk = 1'b0;
    reg locked = 1'b0;
    real half_ns;
    assign clk_o = clk;
    assign locked_o = locked;
    initial begin
        @(posedge clk_i) half_ns = $realtime;
        @(posedge clk_i) half_ns = ($realtime - half_ns) * DIVIDE / TIMES / 2.0;
        forever #(half_ns) clk = ~clk;
    end
    initial #1000 locked = 1'b1;
`endif
endmodule

module PLLE2_BASE #(
    parameter BANDWIDTH = "OPTIMIZED",
    parameter real CLKIN1_PERIOD = 0.0,
    parameter integer DIVCLK_DIVIDE = 1,
    parameter integer CLKFBOUT_MULT = 5,
    parameter integer CLKOUT0_DIVIDE = 1
) (
    input wire CLKIN1, input wire RST, input wire PWRDWN, input wire CLKFBIN,
    output wire CLKFBOUT, output wire CLKOUT0, output wire CLKOUT1, output wire CLKOUT2, output wire CLKOUT3,
    output wire CLKOUT4, output wire CLKOUT5, output wire LOCKED
);
    clock_model #(.TIMES(CLKFBOUT_MULT), .DIVIDE(DIVCLK_DIVIDE * CLKOUT0_DIVIDE)) model (
        .clk_i(CLKIN1), .clk_o(CLKOUT0), .locked_o(LOCKED)
    );
    assign CLKFBOUT = CLKIN1;
    assign {CLKOUT1, CLKOUT2, CLKOUT3, CLKOUT4, CLKOUT5} = 5'b0;
    wire unused = &{1'b0, RST, PWRDWN, CLKFBIN, BANDWIDTH == "OPTIMIZED", CLKIN1_PERIOD > 0.0};
endmodule

module altera_pll #(
    parameter fractional_vco_multiplier = "false",
    parameter reference_clock_frequency = "0 MHz",
    parameter operation_mode = "direct",
    parameter integer number_of_clocks = 1,
    parameter output_clock_frequency0 = "0 MHz",
    parameter phase_shift0 = "0 ps",
    parameter integer duty_cycle0 = 50,
    parameter pll_type = "General",
    parameter pll_subtype = "General"
) (
    input wire refclk, input wire rst, input wire fbclk,
    output wire fboutclk, output wire [0:0] outclk, output wire locked
);
`ifdef VERILATOR
    // Lint only: real delays would be warned about.
    assign outclk = refclk;
    assign locked = 1'b1;
`else
    reg clk = 1'b0;
    reg lock = 1'b0;
    real in_mhz;
    real out_mhz;
    real period_ns;
    integer count;
    assign outclk = clk;
    assign locked = lock;
    initial begin
        count = $sscanf(reference_clock_frequency, "%f MHz", in_mhz);
        count = $sscanf(output_clock_frequency0, "%f MHz", out_mhz);
        @(posedge refclk) period_ns = $realtime;
        @(posedge refclk) period_ns = $realtime - period_ns;
        // Told another reference than there is, it makes another clock than it is told.
        forever #(period_ns * in_mhz / out_mhz / 2.0) clk = ~clk;
    end
    initial #1000 lock = 1'b1;
`endif
    assign fboutclk = refclk;
    wire unused = &{1'b0, rst, fbclk, fractional_vco_multiplier == "false", reference_clock_frequency == "", operation_mode == "direct",
        number_of_clocks == 1, output_clock_frequency0 == "", phase_shift0 == "", duty_cycle0 == 50, pll_type == "", pll_subtype == ""};
endmodule

module EHXPLLL #(
    parameter PLLRST_ENA = "DISABLED",
    parameter INTFB_WAKE = "DISABLED",
    parameter STDBY_ENABLE = "DISABLED",
    parameter DPHASE_SOURCE = "DISABLED",
    parameter OUTDIVIDER_MUXA = "DIVA",
    parameter OUTDIVIDER_MUXB = "DIVB",
    parameter OUTDIVIDER_MUXC = "DIVC",
    parameter OUTDIVIDER_MUXD = "DIVD",
    parameter integer CLKI_DIV = 1,
    parameter integer CLKFB_DIV = 1,
    parameter FEEDBK_PATH = "CLKOP",
    parameter CLKOP_ENABLE = "ENABLED",
    parameter integer CLKOP_DIV = 8,
    parameter integer CLKOP_CPHASE = 0,
    parameter integer CLKOP_FPHASE = 0
) (
    input wire CLKI, input wire CLKFB, input wire RST, input wire STDBY, input wire PHASESEL0, input wire PHASESEL1,
    input wire PHASEDIR, input wire PHASESTEP, input wire PHASELOADREG, input wire PLLWAKESYNC, input wire ENCLKOP,
    output wire CLKOP, output wire LOCK
);
    // The output is fed back, so its own divider does not count.
    clock_model #(.TIMES(CLKFB_DIV), .DIVIDE(CLKI_DIV)) model (
        .clk_i(CLKI), .clk_o(CLKOP), .locked_o(LOCK)
    );
    wire unused = &{1'b0, CLKFB, RST, STDBY, PHASESEL0, PHASESEL1, PHASEDIR, PHASESTEP, PHASELOADREG, PLLWAKESYNC, ENCLKOP,
        PLLRST_ENA == INTFB_WAKE, STDBY_ENABLE == DPHASE_SOURCE, OUTDIVIDER_MUXA == OUTDIVIDER_MUXB,
        OUTDIVIDER_MUXC == OUTDIVIDER_MUXD, FEEDBK_PATH == CLKOP_ENABLE, CLKOP_DIV > CLKOP_CPHASE + CLKOP_FPHASE};
endmodule

module ice40_pll #(
    parameter [3:0] DIVR = 4'd0,
    parameter [6:0] DIVF = 7'd0,
    parameter [2:0] DIVQ = 3'd0
) (
    input wire clk_i, output wire clk_o, output wire locked_o
);
    clock_model #(.TIMES({25'd0, DIVF} + 32'd1), .DIVIDE(({28'd0, DIVR} + 32'd1) << DIVQ)) model (
        .clk_i(clk_i), .clk_o(clk_o), .locked_o(locked_o)
    );
endmodule

module SB_PLL40_CORE #(
    parameter FEEDBACK_PATH = "SIMPLE",
    parameter [3:0] DIVR = 4'd0,
    parameter [6:0] DIVF = 7'd0,
    parameter [2:0] DIVQ = 3'd0,
    parameter [2:0] FILTER_RANGE = 3'd0
) (
    input wire REFERENCECLK, input wire BYPASS, input wire RESETB, output wire PLLOUTGLOBAL, output wire LOCK
);
    ice40_pll #(.DIVR(DIVR), .DIVF(DIVF), .DIVQ(DIVQ)) model (
        .clk_i(REFERENCECLK), .clk_o(PLLOUTGLOBAL), .locked_o(LOCK)
    );
    wire unused = &{1'b0, BYPASS, RESETB, FEEDBACK_PATH == "SIMPLE", FILTER_RANGE > 3'd0};
endmodule

module SB_PLL40_PAD #(
    parameter FEEDBACK_PATH = "SIMPLE",
    parameter [3:0] DIVR = 4'd0,
    parameter [6:0] DIVF = 7'd0,
    parameter [2:0] DIVQ = 3'd0,
    parameter [2:0] FILTER_RANGE = 3'd0
) (
    input wire PACKAGEPIN, input wire BYPASS, input wire RESETB, output wire PLLOUTGLOBAL, output wire LOCK
);
    ice40_pll #(.DIVR(DIVR), .DIVF(DIVF), .DIVQ(DIVQ)) model (
        .clk_i(PACKAGEPIN), .clk_o(PLLOUTGLOBAL), .locked_o(LOCK)
    );
    wire unused = &{1'b0, BYPASS, RESETB, FEEDBACK_PATH == "SIMPLE", FILTER_RANGE > 3'd0};
endmodule

module rPLL #(
    parameter FCLKIN = "100",
    parameter DEVICE = "GW1NR-9C",
    parameter integer IDIV_SEL = 0,
    parameter integer FBDIV_SEL = 0,
    parameter integer ODIV_SEL = 8
) (
    input wire CLKIN, input wire CLKFB, input wire RESET, input wire RESET_P, input wire [5:0] FBDSEL, input wire [5:0] IDSEL,
    input wire [5:0] ODSEL, input wire [3:0] DUTYDA, input wire [3:0] PSDA, input wire [3:0] FDLY,
    output wire CLKOUT, output wire LOCK
);
    clock_model #(.TIMES(FBDIV_SEL + 1), .DIVIDE(IDIV_SEL + 1)) model (
        .clk_i(CLKIN), .clk_o(CLKOUT), .locked_o(LOCK)
    );
    wire unused = &{1'b0, CLKFB, RESET, RESET_P, FBDSEL, IDSEL, ODSEL, DUTYDA, PSDA, FDLY, FCLKIN == DEVICE, ODIV_SEL > 0};
endmodule

`default_nettype wire
