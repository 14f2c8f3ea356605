// Cells of a placed and routed Gowin GW1N that nextpnr writes otherwise than yosys has them: its adders have a table of their own, and
// vectors are wires one by one. The clock manager gives the oscillator on.
module rPLL #(
    parameter ODIV_SEL = 0, parameter IDIV_SEL = 0, parameter FBDIV_SEL = 0, parameter FCLKIN = 0, parameter DEVICE = 0
) (
    input CLKIN, CLKFB, RESET, RESET_P,
    input FBDSEL0, FBDSEL1, FBDSEL2, FBDSEL3, FBDSEL4, FBDSEL5, IDSEL0, IDSEL1, IDSEL2, IDSEL3, IDSEL4, IDSEL5,
    input ODSEL0, ODSEL1, ODSEL2, ODSEL3, ODSEL4, ODSEL5, PSDA0, PSDA1, PSDA2, PSDA3, DUTYDA0, DUTYDA1, DUTYDA2, DUTYDA3,
    input FDLY0, FDLY1, FDLY2, FDLY3,
    output CLKOUT, LOCK
);
    assign CLKOUT = CLKIN;
    assign LOCK = 1'b1;
endmodule
module IBUF #(parameter NET_I = 0, parameter NET_O = 0) (input I, output O);
    assign O = I;
endmodule
module OBUF #(
    parameter NET_I = 0, parameter NET_O = 0, parameter NET_BOTTOM_IO_PORT_A = 0, parameter NET_BOTTOM_IO_PORT_B = 0
) (input I, BOTTOM_IO_PORT_A, BOTTOM_IO_PORT_B, output O);
    assign O = I;
endmodule
module GSR (input GSRI);
endmodule
module GOWIN_GND (output G);
    assign G = 1'b0;
endmodule
module GOWIN_VCC (output V);
    assign V = 1'b1;
endmodule
// An adder: a table of four inputs, I2 high, says whether the carry goes on; if not, its lowest four bits say the carry. The tables of
// the modes are those of the packer; C2L and ONE2C begin a chain, with a carry of 0 and 1, or end it.
module ALU #(parameter ALU_MODE = 2, parameter RAW_ALU_LUT = -1, parameter CIN_NETTYPE = "") (
    input I0, I1, I2, I3, CIN, output SUM, COUT
);
    localparam [15:0] TABLE =
        RAW_ALU_LUT != -1 ? RAW_ALU_LUT :
        ALU_MODE == "C2L" ? 16'h0000 :
        ALU_MODE == "ONE2C" ? 16'h000f : 16'h609a;
    wire goes_on = TABLE[{I3, 1'b1, I1, I0}];
    wire begins = TABLE[{2'b00, I1, I0}];
    assign SUM = goes_on ^ CIN;
    assign COUT = goes_on ? CIN : begins;
    generate
        if (RAW_ALU_LUT == -1 && ALU_MODE != "C2L" && ALU_MODE != "ONE2C" && ALU_MODE != 2) no_model_of_this_mode none ();
    endgenerate
endmodule
module DP #(
    parameter BIT_WIDTH_0 = 9, parameter BIT_WIDTH_1 = 9, parameter READ_MODE0 = 0, parameter READ_MODE1 = 0,
    parameter WRITE_MODE0 = 0, parameter WRITE_MODE1 = 0, parameter [2:0] BLK_SEL_0 = 0, parameter [2:0] BLK_SEL_1 = 0,
    parameter RESET_MODE = "SYNC"
) (
    input CLKA, CEA, OCEA, RESETA, WREA, CLKB, CEB, OCEB, RESETB, WREB,
    input ADA0, ADA1, ADA2, ADA3, ADA4, ADA5, ADA6, ADA7, ADA8, ADA9, ADA10, ADA11, ADA12, ADA13,
    input ADB0, ADB1, ADB2, ADB3, ADB4, ADB5, ADB6, ADB7, ADB8, ADB9, ADB10, ADB11, ADB12, ADB13,
    input BLKSELA0, BLKSELA1, BLKSELA2, BLKSELB0, BLKSELB1, BLKSELB2,
    input DIA0, DIA1, DIA2, DIA3, DIA4, DIA5, DIA6, DIA7, DIA8, DIA9, DIA10, DIA11, DIA12, DIA13, DIA14, DIA15, DIA16, DIA17,
    input DIB0, DIB1, DIB2, DIB3, DIB4, DIB5, DIB6, DIB7, DIB8, DIB9, DIB10, DIB11, DIB12, DIB13, DIB14, DIB15, DIB16, DIB17,
    output DOA0, DOA1, DOA2, DOA3, DOA4, DOA5, DOA6, DOA7, DOA8, DOA9, DOA10, DOA11, DOA12, DOA13, DOA14, DOA15, DOA16, DOA17,
    output DOB0, DOB1, DOB2, DOB3, DOB4, DOB5, DOB6, DOB7, DOB8, DOB9, DOB10, DOB11, DOB12, DOB13, DOB14, DOB15, DOB16, DOB17
);
    generate
        if (BIT_WIDTH_0 != BIT_WIDTH_1 || BIT_WIDTH_0 > 9 || READ_MODE0 != 0 || READ_MODE1 != 0) no_model_of_this_memory none ();
    endgenerate
    block_ram #(.WIDTH(BIT_WIDTH_0), .WRITE_A(WRITE_MODE0), .WRITE_B(WRITE_MODE1)) ram (
        .clock_a(CLKA), .enable_a(CEA && {BLKSELA2, BLKSELA1, BLKSELA0} == BLK_SEL_0), .write_a(WREA), .reset_a(RESETA),
        .address_a({ADA13, ADA12, ADA11, ADA10, ADA9, ADA8, ADA7, ADA6, ADA5, ADA4, ADA3, ADA2, ADA1, ADA0}),
        .in_a({DIA8, DIA7, DIA6, DIA5, DIA4, DIA3, DIA2, DIA1, DIA0}),
        .out_a({DOA8, DOA7, DOA6, DOA5, DOA4, DOA3, DOA2, DOA1, DOA0}),
        .clock_b(CLKB), .enable_b(CEB && {BLKSELB2, BLKSELB1, BLKSELB0} == BLK_SEL_1), .write_b(WREB), .reset_b(RESETB),
        .address_b({ADB13, ADB12, ADB11, ADB10, ADB9, ADB8, ADB7, ADB6, ADB5, ADB4, ADB3, ADB2, ADB1, ADB0}),
        .in_b({DIB8, DIB7, DIB6, DIB5, DIB4, DIB3, DIB2, DIB1, DIB0}),
        .out_b({DOB8, DOB7, DOB6, DOB5, DOB4, DOB3, DOB2, DOB1, DOB0})
    );
endmodule
