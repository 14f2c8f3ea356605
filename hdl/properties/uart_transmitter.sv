// byte_on_the_line: TX has a start bit, the eight bits of the accepted byte, lowest first, and a stop bit; otherwise it is HIGH.
// tx_bit_timed: TX changes only at the end of a bit, and a bit has its exact length.
reg [3:0] f_bit; initial f_bit = 4'd10;
reg [7:0] f_byte;
reg [14:0] f_since; initial f_since = 15'd0;
always @(posedge clock) begin
    f_since <= f_since + 15'd1;
    if (bit_end) begin
        f_since <= 15'd1;
        if (f_bit != 4'd10) f_bit <= f_bit + 4'd1;
    end
    if (take) begin
        f_bit <= 4'd0;
        f_byte <= data;
    end
    if (reset) begin
        f_bit <= 4'd10;
        f_since <= 15'd0;
    end
end
wire [9:0] f_frame = {1'b1, f_byte, 1'b0};
wire [9:0] f_left = (f_bit == 4'd10) ? 10'd1 : (f_frame >> f_bit);
always @* begin
    byte_on_the_line: assert (shift == f_left);
    byte_on_the_line_ends: assert (!empty | (f_bit >= 4'd9) | ((f_bit == 4'd0) & (f_since == 15'd1)));
    byte_on_the_line_whole: assert (!take | (f_bit >= 4'd9));
    byte_on_the_line_range: assert (f_bit <= 4'd10);
end
reg f_tx; initial f_tx = 1'b1;
reg f_end; initial f_end = 1'b0;
reg f_reset; initial f_reset = 1'b1;
always @(posedge clock) begin
    f_tx <= tx;
    f_end <= bit_end;
    f_reset <= reset;
end
always @* begin
    tx_bit_timed: assert ((tx == f_tx) | f_end | f_reset);
    tx_bit_timed_apart: assert (bit_end ? ((count == 15'd0) & (f_since == LAST_COUNT + 15'd1)) : (f_since == count));
end
