// write_is_whole: A word is written only after a whole command: code, length, four bytes of address, four of data, without framing error or time-out between them.
// first_word_as_sent: The first word of a write command is written as sent, to the address that was sent; an address beyond the map is not written.
// read_is_whole: A byte is read only for a read command that was received whole.
reg [3:0] f_bytes; initial f_bytes = 4'd0;
reg f_is_write; initial f_is_write = 1'b0;
reg f_whole; initial f_whole = 1'b0;
reg f_whole_1; initial f_whole_1 = 1'b0;
reg f_asked; initial f_asked = 1'b0;
reg f_asked_1; initial f_asked_1 = 1'b0;
// nothing of an earlier command is still being written
reg f_first; initial f_first = 1'b0;
reg [31:0] f_address;
reg [31:0] f_word;
wire f_code = (receiver_data >= 8'd1) & (receiver_data <= 8'd4);
wire f_spoilt = receiver_framing_error & !f_asked & (f_bytes != 4'd0);
always @(posedge clock) begin
    f_whole <= receiver_strobe & f_is_write & (f_bytes == 4'd9);
    f_whole_1 <= f_whole;
    f_asked_1 <= f_asked;
    if (receiver_strobe) case (f_bytes)
        4'd0: begin
            f_first <= f_code & receiver_data[0] & !write_busy & !has_byte & !access_due & !access & !step_address;
            if (f_code) begin
                f_bytes <= 4'd1;
                f_is_write <= receiver_data[0];
            end
        end
        4'd1: f_bytes <= 4'd2;
        4'd2, 4'd3, 4'd4: begin
            f_bytes <= f_bytes + 4'd1;
            f_address <= {f_address[23:0], receiver_data};
        end
        4'd5: begin
            f_address <= {f_address[23:0], receiver_data};
            f_bytes <= f_is_write ? 4'd6 : 4'd10;
            f_asked <= !f_is_write & !no_word;
            if (no_word) f_bytes <= 4'd0;
        end
        4'd6, 4'd7, 4'd8, 4'd9: begin
            f_bytes <= (f_bytes == 4'd9) ? 4'd6 : f_bytes + 4'd1;
            f_word <= {f_word[23:0], receiver_data};
        end
        default: ;
    endcase
    if (expired | (word_end & last_word) | f_spoilt) begin
        f_bytes <= (f_spoilt & !expired) ? 4'd11 : 4'd0;
        f_asked <= 1'b0;
    end
    if (done | take_byte | (access & write) | expired | f_spoilt) f_first <= 1'b0;
    if (reset) begin
        f_bytes <= 4'd0;
        f_is_write <= 1'b0;
        f_whole <= 1'b0;
        f_whole_1 <= 1'b0;
        f_asked <= 1'b0;
        f_asked_1 <= 1'b0;
        f_first <= 1'b0;
    end
end
wire [31:0] f_there = has_byte ? {data[23:0], next_byte} : data;
wire [3:0] f_come = (f_whole | f_whole_1) ? 4'd4 : (f_bytes >= 4'd6) & (f_bytes <= 4'd9) ? f_bytes - 4'd6 : 4'd0;
wire [31:0] f_mask = (f_come == 4'd0) ? 32'd0 : 32'hFFFFFFFF >> (6'd32 - {f_come, 3'd0});
always @* begin
    write_is_whole: assert (!(access & write) | f_whole_1);
    write_is_whole_next: assert (!(access_due & writing) | f_whole);
    write_is_whole_state: assert (
        ((state == BRIDGE_STATE_COMMAND) & (f_bytes == 4'd0)) |
        ((state == BRIDGE_STATE_LENGTH) & (f_bytes == 4'd1)) |
        ((state == BRIDGE_STATE_ADDRESS) & (f_bytes == 4'd2 + {2'd0, byte_lane})) |
        ((state == BRIDGE_STATE_WRITE) & f_is_write & (f_bytes == 4'd6 + {2'd0, byte_lane})) |
        ((state == BRIDGE_STATE_READ) & f_asked & !f_is_write & (f_bytes == 4'd10)) |
        ((state == BRIDGE_STATE_DISCARD) & (f_bytes == 4'd11)));
    write_is_whole_kind: assert ((f_bytes == 4'd0) | (writing == f_is_write));
    first_word_as_sent: assert (!(access & write & f_first) | ((write_data == f_word) & (word_address == f_address[10:0]) & (in_range == (f_address[31:11] == 21'd0))));
    first_word_as_sent_so_far: assert (!f_first | (f_is_write & !write_busy & !step_address & (((f_there ^ f_word) & f_mask) == 32'd0)));
    first_word_as_sent_to: assert (!f_first | (f_bytes < 4'd6) | ((address == f_address[10:0]) & (out_of_range == (|f_address[31:11]))));
    first_word_as_sent_to_3: assert (!f_first | (f_bytes != 4'd3) | (out_of_range == (|f_address[7:0])));
    first_word_as_sent_to_4: assert (!f_first | (f_bytes != 4'd4) | (out_of_range == (|f_address[15:0])));
    first_word_as_sent_to_5: assert (!f_first | (f_bytes != 4'd5) | ((out_of_range == (|f_address[23:3])) & (address[2:0] == f_address[2:0])));
    read_is_whole: assert (!(access & !write) | f_asked_1);
    read_is_whole_next: assert (!(access_due & !writing) | f_asked);
    read_is_whole_state: assert (!f_asked | (state == BRIDGE_STATE_READ));
end
