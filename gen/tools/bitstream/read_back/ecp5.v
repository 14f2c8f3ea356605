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
// IOLDO: from the register in the output cell. What is not connected is low here.
module TRELLIS_IO #(
    parameter DIR = "INPUT", parameter DATAMUX_MDDR = 0, parameter DATAMUX_ODDR = 0, parameter DATAMUX_OREG = 0
) (
    inout B, input I, T, IOLDO, IOLTO, output O
);
    generate
        if (DIR == "INPUT") assign O = B; else assign B = I | IOLDO;
    endgenerate
endmodule
// The register in the output cell.
module SIOLOGIC #(
    parameter MODE = "IREG_OREG", parameter [127:0] SRMODE = "LSR_OVER_CE", parameter \OUTREG.REGSET = "RESET",
    parameter [127:0] \OUTREG.OUTREGMODE = "FF", parameter [127:0] CEOMUX = "1", parameter [127:0] LSRMUX = "LSR",
    parameter [127:0] LSROMUX = "LSRMUX", parameter LSRIMUX = 0, parameter [127:0] CLKOMUX = "CLK", parameter CLKIMUX = 0, parameter GSR = 0,
    parameter \DELAY.WAIT_FOR_EDGE = 0, parameter \DELAY.DEL_VALUE = 0, parameter \DELAY.OUTDEL = 0
) (
    input CE, CLK, DI, DIRECTION, IOLDOI, LOADN, LSR, MOVE, PADDI, TSDATA0, TXDATA0, TXDATA1,
    output CFLAG, INDD, INFF, IOLDOD, IOLTO, RXDATA0, RXDATA1, output reg IOLDO
);
    generate
        if (MODE != "IREG_OREG" || SRMODE != "LSR_OVER_CE" || \OUTREG.OUTREGMODE != "FF" || CEOMUX != "1" || LSRMUX != "LSR"
            || LSROMUX != "LSRMUX" || CLKOMUX != "CLK") no_model_of_this_register none ();
    endgenerate
    initial IOLDO = \OUTREG.REGSET == "SET";
    always @(posedge CLK) IOLDO <= LSR ? \OUTREG.REGSET == "SET" : TXDATA0;
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
module DP16KD #(
    parameter DATA_WIDTH_A = 9, parameter DATA_WIDTH_B = 9, parameter [127:0] REGMODE_A = "NOREG", parameter [127:0] REGMODE_B = "NOREG",
    parameter [127:0] WRITEMODE_A = "NORMAL", parameter [127:0] WRITEMODE_B = "NORMAL", parameter [127:0] CSDECODE_A = "0b000",
    parameter [127:0] CSDECODE_B = "0b000", parameter GSR = 0, parameter RESETMODE = 0, parameter ASYNC_RESET_RELEASE = 0
) (
    input CLKA, CEA, OCEA, RSTA, WEA, CSA0, CSA1, CSA2,
    input ADA0, ADA1, ADA2, ADA3, ADA4, ADA5, ADA6, ADA7, ADA8, ADA9, ADA10, ADA11, ADA12, ADA13,
    input DIA0, DIA1, DIA2, DIA3, DIA4, DIA5, DIA6, DIA7, DIA8, DIA9, DIA10, DIA11, DIA12, DIA13, DIA14, DIA15, DIA16, DIA17,
    input CLKB, CEB, OCEB, RSTB, WEB, CSB0, CSB1, CSB2,
    input ADB0, ADB1, ADB2, ADB3, ADB4, ADB5, ADB6, ADB7, ADB8, ADB9, ADB10, ADB11, ADB12, ADB13,
    input DIB0, DIB1, DIB2, DIB3, DIB4, DIB5, DIB6, DIB7, DIB8, DIB9, DIB10, DIB11, DIB12, DIB13, DIB14, DIB15, DIB16, DIB17,
    output DOA0, DOA1, DOA2, DOA3, DOA4, DOA5, DOA6, DOA7, DOA8, DOA9, DOA10, DOA11, DOA12, DOA13, DOA14, DOA15, DOA16, DOA17,
    output DOB0, DOB1, DOB2, DOB3, DOB4, DOB5, DOB6, DOB7, DOB8, DOB9, DOB10, DOB11, DOB12, DOB13, DOB14, DOB15, DOB16, DOB17
);
    localparam WRITE_A = WRITEMODE_A == "WRITETHROUGH" ? 1 : WRITEMODE_A == "READBEFOREWRITE" ? 2 : 0;
    localparam WRITE_B = WRITEMODE_B == "WRITETHROUGH" ? 1 : WRITEMODE_B == "READBEFOREWRITE" ? 2 : 0;
    generate
        if (DATA_WIDTH_A != DATA_WIDTH_B || DATA_WIDTH_A > 9 || REGMODE_A != "NOREG" || REGMODE_B != "NOREG"
            || CSDECODE_A != "0b000" || CSDECODE_B != "0b000") no_model_of_this_memory none ();
    endgenerate
    block_ram #(.WIDTH(DATA_WIDTH_A), .WRITE_A(WRITE_A), .WRITE_B(WRITE_B)) ram (
        .clock_a(CLKA), .enable_a(CEA && {CSA2, CSA1, CSA0} == 3'd0), .write_a(WEA), .reset_a(RSTA),
        .address_a({ADA13, ADA12, ADA11, ADA10, ADA9, ADA8, ADA7, ADA6, ADA5, ADA4, ADA3, ADA2, ADA1, ADA0}),
        .in_a({DIA8, DIA7, DIA6, DIA5, DIA4, DIA3, DIA2, DIA1, DIA0}),
        .out_a({DOA8, DOA7, DOA6, DOA5, DOA4, DOA3, DOA2, DOA1, DOA0}),
        .clock_b(CLKB), .enable_b(CEB && {CSB2, CSB1, CSB0} == 3'd0), .write_b(WEB), .reset_b(RSTB),
        .address_b({ADB13, ADB12, ADB11, ADB10, ADB9, ADB8, ADB7, ADB6, ADB5, ADB4, ADB3, ADB2, ADB1, ADB0}),
        .in_b({DIB8, DIB7, DIB6, DIB5, DIB4, DIB3, DIB2, DIB1, DIB0}),
        .out_b({DOB8, DOB7, DOB6, DOB5, DOB4, DOB3, DOB2, DOB1, DOB0})
    );
endmodule
