// Cells of a placed and routed ECP5, as nextpnr writes them: besides what yosys' own models of them have, the choice between DI and M, and
// the carry behind CCU2. The clock manager gives the oscillator on.
module EHXPLLL #(
    parameter CLKI_DIV = 0, parameter CLKFB_DIV = 0, parameter CLKOP_DIV = 0, parameter CLKOP_CPHASE = 0, parameter CLKOP_FPHASE = 0,
    parameter CLKOP_ENABLE = 0, parameter FEEDBK_PATH = 0, parameter DPHASE_SOURCE = 0, parameter PLLRST_ENA = 0,
    parameter INTFB_WAKE = 0, parameter STDBY_ENABLE = 0, parameter OUTDIVIDER_MUXA = 0, parameter OUTDIVIDER_MUXB = 0,
    parameter OUTDIVIDER_MUXC = 0, parameter OUTDIVIDER_MUXD = 0
) (
    input CLKI, CLKFB, RST, STDBY, PHASESEL0, PHASESEL1, PHASEDIR, PHASESTEP, PHASELOADREG, PLLWAKESYNC, ENCLKOP,
    output CLKOP, LOCK
);
    assign CLKOP = CLKI;
    assign LOCK = 1'b1;
endmodule
module DCCA (input CLKI, input CE, output CLKO);
    assign CLKO = CLKI;
endmodule
module TRELLIS_IO #(parameter DIR = "INPUT", parameter DATAMUX_MDDR = 0, parameter DATAMUX_ODDR = 0) (inout B, input I, input T, output O);
    generate
        if (DIR == "INPUT") assign O = B; else assign B = I;
    endgenerate
endmodule
module TRELLIS_FF #(
    parameter GSR = 0, parameter [127:0] CEMUX = "1", parameter CLKMUX = "CLK", parameter LSRMUX = "LSR", parameter SRMODE = "LSR_OVER_CE",
    parameter REGSET = "RESET", parameter LSRMODE = "LSR", parameter SD = "1"
) (input CLK, LSR, CE, DI, M, output reg Q);
    wire enable = CEMUX == "1" ? 1'b1 : CEMUX == "0" ? 1'b0 : CEMUX == "INV" ? !CE : CE;
    wire set = LSRMUX == "INV" ? !LSR : LSR;
    wire clock = CLKMUX == "INV" ? !CLK : CLK;
    wire next = SD == "0" ? M : DI;
    initial Q = REGSET == "SET";
    generate
        if (SRMODE == "ASYNC") begin
            always @(posedge clock, posedge set)
                if (set) Q <= REGSET == "SET";
                else if (enable) Q <= next;
        end else begin
            always @(posedge clock)
                if (set) Q <= REGSET == "SET";
                else if (enable) Q <= next;
        end
    endgenerate
endmodule
module TRELLIS_COMB #(
    parameter MODE = "LOGIC", parameter [15:0] INITVAL = 16'h0, parameter CCU2_INJECT1 = "NO", parameter WREMUX = "WRE", parameter IS_Z1 = 0
) (
    input A, B, C, D, M, FCI, F1, FXA, FXB, WD, WAD0, WAD1, WAD2, WAD3, WRE, WCK,
    output F, FCO, OFX
);
    wire table_out = INITVAL[{D, C, B, A}];
    generate
        if (MODE == "CCU2") begin
            wire carry = CCU2_INJECT1 == "YES" ? 1'b0 : FCI;
            wire half = CCU2_INJECT1 == "YES" ? 1'b0 : INITVAL[{2'b00, B, A}];
            assign F = table_out ^ carry;
            assign FCO = table_out ? FCI : half;
        end else if (MODE == "DPRAM") begin
            reg [15:0] ram = INITVAL;
            always @(posedge WCK) if (WRE) ram[{WAD3, WAD2, WAD1, WAD0}] <= WD;
            assign F = ram[{A, C, B, D}];
        end else assign F = table_out;
        assign OFX = IS_Z1 ? (M ? FXB : FXA) : (M ? F1 : F);
    endgenerate
endmodule
