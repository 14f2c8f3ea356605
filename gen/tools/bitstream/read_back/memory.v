// Block RAM as ECP5 and Gowin GW1N have it: two ports with a clock each, one width up to 9 at both, no register behind the output.
// WRITE_*: what the output of a port does that writes: 0 stays, 1 what is written, 2 what was there.
module block_ram #(parameter WIDTH = 9, parameter WRITE_A = 0, parameter WRITE_B = 0) (
    input clock_a, enable_a, write_a, reset_a, input [13:0] address_a, input [8:0] in_a, output reg [8:0] out_a,
    input clock_b, enable_b, write_b, reset_b, input [13:0] address_b, input [8:0] in_b, output reg [8:0] out_b
);
    localparam SHIFT = WIDTH >= 8 ? 3 : WIDTH == 4 ? 2 : WIDTH == 2 ? 1 : 0;
    reg [8:0] words [0:(1 << (14 - SHIFT)) - 1];
    integer k;
    initial begin
        for (k = 0; k < 1 << (14 - SHIFT); k = k + 1) words[k] = 9'd0;
        out_a = 9'd0;
        out_b = 9'd0;
    end
    always @(posedge clock_a) if (enable_a) begin
        if (write_a) words[address_a[13:SHIFT]] <= in_a;
        if (reset_a) out_a <= 9'd0;
        else if (!write_a || WRITE_A == 2) out_a <= words[address_a[13:SHIFT]];
        else if (WRITE_A == 1) out_a <= in_a;
    end
    always @(posedge clock_b) if (enable_b) begin
        if (write_b) words[address_b[13:SHIFT]] <= in_b;
        if (reset_b) out_b <= 9'd0;
        else if (!write_b || WRITE_B == 2) out_b <= words[address_b[13:SHIFT]];
        else if (WRITE_B == 1) out_b <= in_b;
    end
endmodule
