// driver_only: The driver is on only while a request is being sent.
// refused_unless_quiet: A request begins only for a trigger with a known ID, when the line is HIGH and has been quiet since an incomplete reply.
// quiet_after_reset: After a reset no request begins for 63 us, the longest pause before a reply, and then only when the line is at rest.
// one_verdict: A trigger outside an exchange has exactly one verdict, and no verdict comes without a trigger.
// request_as_asked: A request is a LOW start bit, sync code, ID and parity, and a HIGH delimiter; after the request the line is HIGH.
// header_as_asked: A reply is good only if its first eight bits are the sync code, the ID of the request and the right parity; without guards as long as that ID stays.
// sum_as_received: A reply is good only if its bytes as sampled, the CRC among them, come to 0.
reg f_owed; initial f_owed = 1'b0;
reg f_past_valid; initial f_past_valid = 1'b0;
reg [7:0] f_header;
reg [7:0] f_sum;
wire [3:0] f_bits = (index > 4'd8) ? 4'd0 : index;
wire [7:0] f_come = 8'hff >> (4'd8 - f_bits);
wire [7:0] f_first = f_header >> (4'd8 - f_bits);
always @(posedge clock) begin
    f_past_valid <= 1'b1;
    if (publish & !hold) f_owed <= 1'b0;
    if (trigger & !busy) f_owed <= 1'b1;
    if (reset) f_owed <= 1'b0;
    if (take & order_is_control) f_header <= {level, f_header[7:1]};
    if (take) f_sum[index[2:0]] <= f_sum[index[2:0]] ^ level;
    if ((phase == PHASE_REST) | ((phase == PHASE_WAIT) & order_is_control)) f_sum <= 8'd0;
end
always @(posedge clock) if (f_past_valid & !$past(reset)) begin
    if ($past(unsettled) & !unsettled) quiet_after_reset: assert ($past(((phase == PHASE_REST) & expired) | ((phase == PHASE_JUDGE) & is_whole)));
    if (driver & !$past(driver)) refused_unless_quiet: assert ($past(trigger & level & order_is_known & !unsettled));
end
always @(posedge clock) if (f_past_valid) begin
    if ($past(reset)) quiet_after_reset_begins: assert (unsettled & (timer == 7'd63) & (phase == PHASE_REST));
    if (!$past(reset) & $past((phase == PHASE_REST) & unsettled) & (phase == PHASE_REST)) quiet_after_reset_waits: assert ((timer == $past(timer)) | ($past(tick_us) & (timer == $past(timer) - 7'd1)) | $past(!level & (timer[6] | !(|timer[5:4]))));
end
// as long as the ID stays, which it does while an exchange is under way
reg [3:0] f_id;
reg f_id_stays; initial f_id_stays = 1'b0;
wire [7:0] f_control = {^request_id, request_id, 3'b010};
wire f_id_is_held = f_id_stays & (f_id == request_id);
always @(posedge clock) begin
    f_id <= request_id;
    f_id_stays <= f_id_is_held | (phase == PHASE_REST);
end
always @* begin
    request_as_asked: assert ((phase != PHASE_SEND) | ((index == 4'd15) ? line : (index == 4'd0) ? !line : !order_is_control | !f_id_is_held | (line == f_control[index[2:0] - 3'd1])));
    request_as_asked_bits: assert ((phase != PHASE_SEND) | (index <= 4'd8) | (index == 4'd15));
    request_as_asked_rest: assert (line | (phase == PHASE_SEND) | (phase == PHASE_JUDGE) | (phase == PHASE_REST));
end
wire f_in_reply = (phase == PHASE_FIELD) | (phase == PHASE_WAIT) | (phase == PHASE_JUDGE);
wire [15:0] f_turned = {f_sum, f_sum} >> f_bits[2:0];
always @* begin
    driver_only: assert (!driver | (phase == PHASE_SEND) | (phase == PHASE_RELEASE));
    one_verdict: assert (f_owed == (phase != PHASE_REST));
    one_verdict_owed: assert (!publish | f_owed);
    header_as_asked: assert (!(publish & good) | !(HAS_GUARDS | f_id_is_held) | ((f_header[6:0] == {request_id, 3'b010}) & !(^f_header[7:3])));
    header_as_asked_echo: assert ((phase != PHASE_FIELD) | !order_is_control | bad_echo | !f_id_is_held | (((f_first[6:3] ^ request_id) & f_come[6:3]) == 4'd0));
    header_as_asked_echoed: assert (!f_in_reply | refused | upset | order_is_control | bad_echo | !f_id_is_held | (f_header[6:3] == request_id));
    header_as_asked_ends: assert ((phase != PHASE_JUDGE) | refused | missed | bad_delimiter | upset | (order_is_crc & (index == 4'd9)));
    header_as_asked_bits: assert ((phase != PHASE_FIELD) | (index <= 4'd8) | (index == 4'd15));
    header_as_asked_sync: assert ((phase != PHASE_FIELD) | !order_is_control | (((f_first ^ 8'h02) & f_come & 8'h07) == 8'd0));
    header_as_asked_id: assert ((phase != PHASE_FIELD) | !order_is_control | ((f_bits >= 4'd7) ? (echo == f_first[6:3]) : (f_bits > 4'd3) ? (({4'd0, echo} >> (4'd7 - f_bits)) == ({3'd0, f_first[7:3]} & (f_come >> 3))) : (echo == 4'd0)));
    header_as_asked_parity: assert ((phase != PHASE_FIELD) | !order_is_control | (bad_parity == ^(f_first & f_come & 8'hf8)));
    header_as_asked_after: assert (!f_in_reply | refused | upset | order_is_control | ((f_header[2:0] == 3'b010) & (echo == f_header[6:3]) & (bad_parity == ^f_header[7:3])));
    header_as_asked_begins: assert (((phase != PHASE_SEND) & (phase != PHASE_RELEASE) & ((phase != PHASE_WAIT) | !order_is_control)) | ((echo == 4'd0) & !bad_parity & (order_is_control | (phase == PHASE_SEND))));
    sum_as_received: assert (!(publish & good) | (f_sum == 8'd0));
    sum_as_received_so_far: assert ((phase != PHASE_FIELD) | order_is_crc | bad_crc | (check == f_turned[7:0]));
    sum_as_received_waits: assert ((phase != PHASE_WAIT) | order_is_control | bad_crc | (check == f_sum));
    sum_as_received_crc: assert ((phase != PHASE_FIELD) | !order_is_crc | bad_crc | (((f_sum & f_come) == 8'd0) & (((check ^ f_turned[7:0]) & (8'hff >> f_bits)) == 8'd0)));
    sum_as_received_end: assert ((phase != PHASE_JUDGE) | !order_is_crc | bad_crc | refused | missed | upset | bad_delimiter | (f_sum == 8'd0));
end
