// Stands in for the clock manager, SB_PLL40_CORE or SB_PLL40_PAD: gives the oscillator on, from whichever of its inputs it comes.
module clock_stand_in #(
    parameter FEEDBACK_PATH = 0, parameter DELAY_ADJUSTMENT_MODE_FEEDBACK = 0, parameter DELAY_ADJUSTMENT_MODE_RELATIVE = 0,
    parameter SHIFTREG_DIV_MODE = 0, parameter FDA_FEEDBACK = 0, parameter FDA_RELATIVE = 0, parameter PLLOUT_SELECT = 0,
    parameter DIVR = 0, parameter DIVF = 0, parameter DIVQ = 0, parameter FILTER_RANGE = 0, parameter ENABLE_ICEGATE = 0,
    parameter TEST_MODE = 0, parameter EXTERNAL_DIVIDE_FACTOR = 1
) (
    input REFERENCECLK, input PACKAGEPIN, output PLLOUTCORE, output PLLOUTGLOBAL, input EXTFEEDBACK, input [7:0] DYNAMICDELAY,
    output LOCK, input BYPASS, input RESETB, input LATCHINPUTVALUE, input SDI, input SCLK, output SDO
);
    assign PLLOUTCORE = REFERENCECLK | PACKAGEPIN;
    assign PLLOUTGLOBAL = PLLOUTCORE;
    assign LOCK = 1'b1;
endmodule
